//! Cast shadows: the share of a light that the mesh blocks from its own surface.

use capture::Mesh;
use capture::gbuffer::Atlas;
use capture::rays::Occluder;
use glam::Vec3;
use rayon::prelude::*;

use super::light_cells::CellLight;
use crate::metrics::luminance;

/// The share of all light, of the darkest cells together, that gets no ray.
const LEFT_OUT: f64 = 0.01;
/// The height above the surface at which rays start, as a share of the longest side of the mesh's box; as in solvers.
const LIFT: f32 = 1.6e-3;

/// Directions with their luminance, the brightest first, without those that together bring next to nothing.
fn brightest(light: &CellLight) -> Vec<(Vec3, f64)> {
    let cells = light.picture.data.chunks_exact(3).enumerate();
    let mut cells: Vec<(Vec3, f64)> = cells
        .map(|(cell, rgb)| {
            let direction = CellLight::direction(cell);
            (direction.as_vec3(), luminance(rgb.iter().map(|value| f64::from(*value))))
        })
        .collect();
    cells.sort_by(|a, b| b.1.total_cmp(&a.1));
    let all: f64 = cells.iter().map(|(_, light)| light).sum();
    let mut kept = 0.0;
    cells.retain(|(_, light)| {
        let wanted = kept < (1.0 - LEFT_OUT) * all;
        kept += light;
        wanted
    });
    cells
}

/// The share, 0 to 1, of the irradiance of every texel that the mesh blocks on its way, as if the light came from
/// infinitely far; 0 where the surface is turned away from all light. Texels outside the chart have that of the
/// nearest one inside.
pub(super) fn cast_shadow(mesh: &Mesh, atlas: &Atlas, light: &CellLight) -> Vec<f32> {
    let (occluder, cells) = (Occluder::new(mesh), brightest(light));
    let (low, high) = mesh.bounds();
    let lift = LIFT * (high - low).max_element();
    let texel = |at: usize| {
        let normal = atlas.normals[at];
        let origin = atlas.positions[at] + lift * normal;
        let (mut all, mut blocked) = (0.0, 0.0);
        for (direction, light) in &cells {
            let cosine = f64::from(normal.dot(*direction));
            if cosine > 0.0 {
                all += cosine * light;
                if occluder.first_hit(origin, *direction).is_some() {
                    blocked += cosine * light;
                }
            }
        }
        if all > 0.0 { (blocked / all) as f32 } else { 0.0 }
    };
    (0..atlas.inside.len()).into_par_iter().map(texel).collect()
}

#[cfg(test)]
mod tests {
    use formats::picture::Picture;
    use glam::{DVec3, Vec2};

    use super::super::light_cells::{COLUMNS, ROWS};
    use super::*;

    /// A floor of the unit square in z = 0, its chart the unit square, and a wall of height 1 along x = 0 that is
    /// no part of the chart's inside.
    fn floor_and_wall() -> Mesh {
        let at = Vec3::new;
        let uv = Vec2::new;
        Mesh {
            positions: vec![
                at(0.0, 0.0, 0.0),
                at(1.0, 0.0, 0.0),
                at(1.0, 1.0, 0.0),
                at(0.0, 1.0, 0.0),
                at(0.0, -9.0, 0.0),
                at(0.0, 9.0, 0.0),
                at(0.0, 9.0, 1.0),
                at(0.0, -9.0, 1.0),
            ],
            normals: [[Vec3::Z; 4], [Vec3::X; 4]].concat(),
            uvs: [[uv(0.0, 0.0), uv(1.0, 0.0), uv(1.0, 1.0), uv(0.0, 1.0)], [uv(2.0, 2.0); 4]]
                .concat(),
            triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
        }
    }

    fn light_of(lit: impl Fn(DVec3) -> f32) -> CellLight {
        let values = (0..ROWS * COLUMNS).flat_map(|cell| [lit(CellLight::direction(cell)); 3]);
        CellLight::of_cells(Picture {
            width: COLUMNS,
            height: ROWS,
            channels: 3,
            data: values.collect(),
        })
    }

    #[test]
    fn a_wall_shades_the_floor_as_far_as_its_lamp_stands_low() {
        let mesh = floor_and_wall();
        let atlas = Atlas::new(&mesh, 64);
        // One lamp behind the wall: its shadow has the wall's height over the tangent of the lamp's elevation.
        let cell = CellLight::cell(DVec3::new(-0.5, 0.1, 0.8));
        let towards = CellLight::direction(cell);
        let shadow = cast_shadow(&mesh, &atlas, &light_of(|d| f32::from(u8::from(d == towards))));
        let reach = (-towards.x / towards.z) as f32;
        for (at, found) in shadow.into_iter().enumerate() {
            let x = atlas.positions[at].x;
            if (x - reach).abs() > 0.03 {
                assert_eq!(found, f32::from(u8::from(x < reach)), "{x} {reach}");
            }
        }
    }

    #[test]
    fn under_an_even_sky_a_long_wall_takes_what_the_formula_says() {
        let mesh = floor_and_wall();
        let atlas = Atlas::new(&mesh, 32);
        let shadow = cast_shadow(&mesh, &atlas, &light_of(|_| 1.0));
        // A wall without ends, seen under the angle a from the foot: (1 - cos a) / 2 of the cosine-weighted sky.
        for at in (0..32 * 32).filter(|at| (12..20).contains(&(at / 32))) {
            let x = atlas.positions[at].x;
            let expected = 0.5 * (1.0 - x / x.hypot(1.0));
            assert!((shadow[at] - expected).abs() < 0.03, "{x}: {} {expected}", shadow[at]);
        }
    }
}
