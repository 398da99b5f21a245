use glam::DVec3;

use super::*;

/// A grid of 16 x 16 quads in space, its UV by a function of the quad and the place in it.
fn examined(parts: usize, uv: impl Fn(usize, usize, DVec2) -> DVec2) -> Result<usize, LayoutFault> {
    const STEPS: usize = 16;
    let (mut positions, mut uvs, mut triangles) = (vec![], vec![], vec![]);
    let names = (0..parts).map(|part| format!("material \"m{part}\"")).collect();
    let mut of = vec![];
    for (i, j) in (0..STEPS * STEPS).map(|quad| (quad % STEPS, quad / STEPS)) {
        let base = positions.len() as u32;
        for (x, y) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            let place = DVec2::new((i + x) as f64, (j + y) as f64) / STEPS as f64;
            positions.push(place.extend(0.0));
            uvs.push(uv(i, j, place));
        }
        triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
        of.extend([(i * parts / STEPS) as u32; 2]);
    }
    let parts = Parts { names, of };
    let layout = Layout { positions: &positions, uvs: &uvs, triangles: &triangles, parts: &parts };
    examine(&layout)
}

#[test]
fn layouts_are_sound_or_named() {
    let turned = DVec2::from_angle(0.3);
    assert_eq!(examined(1, |_, _, p| p), Ok(1));
    assert_eq!(examined(2, |_, _, p| DVec2::splat(0.5) + 0.6 * turned.rotate(p - 0.5)), Ok(1));
    // A gap around every quad.
    let apart = |i: usize, j: usize, p: DVec2| {
        let corner = DVec2::new(i as f64, j as f64) / 16.0;
        corner + 0.9 * (p - corner)
    };
    let islands = examined(1, apart).unwrap();
    assert!((240..=256).contains(&islands), "{islands}");
    assert!(islands_warning(islands).unwrap().contains("UV islands"));
    assert_eq!(islands_warning(99), None);
    let pages = |i: usize, _: usize, p: DVec2| DVec2::new(2.0 * p.x - (i / 8) as f64, p.y);
    let mirrored = |_: usize, _: usize, p: DVec2| DVec2::new((2.0 * p.x - 1.0).abs(), p.y);
    let cases: [(Result<usize, LayoutFault>, &str); 8] = [
        (
            examined(2, pages),
            "material \"m0\" and material \"m1\" lie over each other in UV: two triangles claim \
             100.0 % of the texels in use; unwrap the mesh again to one page",
        ),
        (examined(1, pages), "material \"m0\" overlaps in UV: two triangles claim 100.0 %"),
        (examined(1, mirrored), "overlaps in UV (mirrored halves): two triangles claim 99."),
        (
            examined(1, |i, _, p| DVec2::new(p.x - if i == 0 { 0.0 } else { 0.05 }, p.y)),
            // 1/19 of the chart, as the check's grid of texels has it.
            "two triangles claim 5.2 % of the texels in use",
        ),
        (
            examined(2, |i, j, p| pages(i, j, p) + DVec2::new((i / 8) as f64, 0.0)),
            "UVs lie on 2 tiles (UDIM 1001, 1002); a map is one page",
        ),
        (examined(1, |_, _, p| p + 0.3), "UVs reach from (0.3, 0.3) to (1.3, 1.3); move all"),
        (
            examined(1, |i, _, p| if i == 3 { DVec2::new(p.x, 0.5) } else { p }),
            "6.2 % of the surface has no area in UV",
        ),
        (examined(1, |_, _, p| p / 0.0), "UVs are not finite"),
    ];
    for (found, expected) in cases {
        let found = found.unwrap_err().to_string();
        assert!(found.contains(expected), "{found}\n{expected}");
    }
}

#[test]
fn a_triangle_that_stands_in_a_file_twice_claims_no_texel_twice() {
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let uvs = [DVec2::ZERO, DVec2::X, DVec2::Y];
    let parts = Parts { names: vec!["object \"a\"".to_owned()], of: vec![0, 0] };
    let triangles = [[0, 1, 2], [0, 2, 1]];
    let layout = Layout { positions: &positions, uvs: &uvs, triangles: &triangles, parts: &parts };
    assert_eq!(examine(&layout), Ok(1));
}
