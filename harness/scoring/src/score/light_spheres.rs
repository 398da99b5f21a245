//! Spheres in a light, seen from the front: what a light is worth to a mirror, to a gloss and to
//! paint.

use formats::picture::{GrayImage, Picture};
use glam::DVec3;
use rayon::prelude::*;

use super::light_cells::CellLight;

/// Pixels along an edge.
const SIDE: usize = 64;
/// Exponent of the cosine lobe around the mirrored direction.
const GLOSS: i32 = 60;

/// Material of a sphere; all reflect all light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Surface {
    Mirror,
    Glossy,
    /// Lambert's law, nothing in its way.
    Diffuse,
}

/// 255 on the sphere.
pub(super) fn disc() -> GrayImage {
    let data = (0..SIDE * SIDE).map(|i| u8::from(normal(i).is_some()) * 255).collect();
    GrayImage { width: SIDE, height: SIDE, data }
}

/// Normal at a pixel: the sphere fills the picture, looked at along -z from far away.
fn normal(pixel: usize) -> Option<DVec3> {
    let at = |i: usize| (2.0 * i as f64 + 1.0) / SIDE as f64 - 1.0;
    let (x, y) = (at(pixel % SIDE), -at(pixel / SIDE));
    let rest = 1.0 - x * x - y * y;
    (rest > 0.0).then(|| DVec3::new(x, y, rest.sqrt()))
}

/// The radiance that leaves the sphere for the viewer, [SIDE, SIDE, 3]; black beside it.
pub(super) fn sphere(light: &CellLight, surface: Surface) -> Picture {
    let cells: Vec<(DVec3, DVec3)> = light
        .picture
        .data
        .chunks_exact(3)
        .enumerate()
        .map(|(i, rgb)| {
            let radiance = DVec3::new(f64::from(rgb[0]), f64::from(rgb[1]), f64::from(rgb[2]));
            (CellLight::direction(i), radiance)
        })
        .collect();
    let mean = |axis: DVec3, weight: &dyn Fn(f64) -> f64| -> DVec3 {
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for (direction, radiance) in &cells {
            let weight = weight(direction.dot(axis).max(0.0));
            sum += *radiance * weight;
            weights += weight;
        }
        sum / weights
    };
    let shaded = |pixel: usize| {
        let Some(normal) = normal(pixel) else { return DVec3::ZERO };
        let mirrored = 2.0 * normal.z * normal - DVec3::Z;
        match surface {
            Surface::Mirror => cells[CellLight::cell(mirrored)].1,
            Surface::Glossy => mean(mirrored, &|cosine| cosine.powi(GLOSS)),
            Surface::Diffuse => mean(normal, &|cosine| cosine),
        }
    };
    let colours: Vec<DVec3> = (0..SIDE * SIDE).into_par_iter().map(shaded).collect();
    let data = colours.iter().flat_map(|colour| colour.as_vec3().to_array()).collect();
    Picture { width: SIDE, height: SIDE, channels: 3, data }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn in_an_even_light_every_sphere_is_as_bright_as_the_light() {
        let mut even = Picture::new(64, 32, 3);
        even.data.fill(0.7);
        let light = CellLight::of_cells(even);
        for surface in [Surface::Mirror, Surface::Glossy, Surface::Diffuse] {
            let picture = sphere(&light, surface);
            let inside = disc().data;
            for (i, rgb) in picture.data.chunks_exact(3).enumerate() {
                let expected = if inside[i] > 0 { 0.7 } else { 0.0 };
                assert!((rgb[1] - expected).abs() < 1e-5, "{surface:?} {i}: {rgb:?}");
            }
        }
    }

    #[test]
    fn under_one_lamp_paint_follows_lamberts_law() {
        let mut dark = Picture::new(64, 32, 3);
        let cell = CellLight::cell(DVec3::new(0.3, 0.2, 0.93).normalize());
        dark.data[3 * cell..3 * cell + 3].fill(1000.0);
        let lamp = CellLight::direction(cell);
        let picture = sphere(&CellLight::of_cells(dark), Surface::Diffuse);
        let solid = 4.0 * std::f64::consts::PI / 2048.0;
        for pixel in [10 * SIDE + 32, 32 * SIDE + 40, 50 * SIDE + 20] {
            let expected =
                1000.0 * solid / std::f64::consts::PI * normal(pixel).unwrap().dot(lamp).max(0.0);
            let found = f64::from(picture.data[3 * pixel]);
            assert!((found - expected).abs() < 5e-3 * expected.max(0.1), "{found} {expected}");
        }
    }
}
