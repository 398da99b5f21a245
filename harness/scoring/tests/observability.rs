//! What a capture could determine of its texels, where formulas say it.

#![allow(clippy::unwrap_used)]

mod bench;
mod noise;
mod plane;

use std::fs;

use bench::{Bench, write_lights};
use plane::{CAMERAS, DISTANCE, FOCAL, HALF, SIDE, albedo, shading};
use scoring::score::Observability;

/// Where a texel lies in the texture.
fn uv(texel: usize) -> [f64; 2] {
    let [x, y] = [texel % SIDE, texel / SIDE].map(|place| (place as f64 + 0.5) / SIDE as f64);
    [x, 1.0 - y]
}

#[test]
fn a_plane_is_seen_lit_and_clipped_as_its_formulas_say() {
    let bench = Bench::new(1e-5);
    let found = Observability::of(&bench.capture()).unwrap();
    assert!(found.cast_shadow.is_none() && found.saturation.is_none());
    let compared: Vec<usize> =
        (0..SIDE * SIDE).filter(|texel| found.compared.data[*texel] == 255).collect();
    assert!(compared.len() > SIDE * SIDE / 2);

    let scene = bench.capture().join("truth/scene.toml");
    let clipping = "[image_formation]\nexposure_stops = 1.0\nwhite_level = 0.7\n";
    fs::write(&scene, fs::read_to_string(&scene).unwrap() + clipping).unwrap();
    write_lights(&bench.capture(), &bench.albedo_maps(SIDE, albedo));
    let found = Observability::of(&bench.capture()).unwrap();
    // Nothing stands on a plane.
    assert!(found.cast_shadow.unwrap().data.iter().all(|share| *share == 0.0));
    let saturation = found.saturation.unwrap();

    let light_of = |texel: usize| shading(uv(texel)[0], uv(texel)[1])[0];
    let mut sorted: Vec<f64> = compared.iter().map(|texel| light_of(*texel)).collect();
    sorted.sort_by(f64::total_cmp);
    let median = sorted[sorted.len() / 2];
    let (mut clipped, mut unclipped) = (0, 0);
    for texel in compared {
        let [u, v] = uv(texel);
        let at = [u, v].map(|place| (2.0 * place - 1.0) * HALF);
        // The first three cameras look along -z and see this far aside.
        let reach = SIDE as f64 / 2.0 / FOCAL * DISTANCE;
        let aside = |camera: &[f64; 2]| [0, 1].map(|axis| (at[axis] - camera[axis]).abs());
        let apart: Vec<[f64; 2]> = CAMERAS[..3].iter().map(aside).collect();
        if apart.iter().flatten().any(|apart| (apart - reach).abs() < 0.003) {
            continue;
        }
        let seen = apart.into_iter().filter(|[x, y]| x.max(*y) < reach);
        let nearest = seen.map(|[x, y]| x.hypot(y)).fold(f64::INFINITY, f64::min);
        let angle = (nearest / DISTANCE).atan().to_degrees();
        assert!((f64::from(found.obliqueness.data[texel]) - angle).abs() < 0.05, "{texel}");
        if nearest.is_infinite() {
            continue;
        }
        let light = f64::from(found.light.data[texel]) * median / light_of(texel);
        assert!((light - 1.0).abs() < 0.03, "{texel}: {light}");
        let white = 0.35;
        let value = albedo(u, v)[0];
        if (value - white).abs() > 0.01 {
            let expected = f32::from(u8::from(value > white));
            assert_eq!(saturation.data[texel], expected, "{texel}: {value}");
            if expected > 0.0 { clipped += 1 } else { unclipped += 1 }
        }
        assert_eq!(found.views.data[texel], if texel / SIDE < 8 { 1.0 } else { 3.0 });
    }
    assert!(clipped > 100 && unclipped > 100, "{clipped} {unclipped}");
}
