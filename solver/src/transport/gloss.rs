//! The highlights that a light makes on skin, by the transport's visibility.

use glam::Vec3;
use rayon::prelude::*;

use super::Transport;
use crate::model::planes::Planes;
use crate::model::samples::{Samples, schlick};

/// Reflectance of skin at normal incidence in Schlick's approximation.
const F0: f32 = 0.04;
/// GGX roughness and share of skin's two lobes.
const LOBES: [(f32, f32); 2] = [(0.15, 0.5), (0.35, 0.5)];
/// Exponent of the cosine lobe that the light is seen through.
const LOBE: i32 = 16;
/// Least cosine of a direction to the surface.
const GRAZING: f32 = 1e-3;

impl Transport {
    /// Radiance that skin of reflectance 1 at normal incidence would send to the camera of every
    /// sample, on the mesh normals, in the luminance of a light of R, G, B per cell, scaled so that its
    /// [`Self::peak`] is 1. `None` unless the transport holds what is open ([`super::Beside::Bending`]).
    pub fn highlights(&self, light: &[f32], samples: &Samples) -> Option<Planes> {
        let open = self.open.as_ref()?;
        let centres = self.sky.centres();
        let scale = std::f32::consts::PI / (F0 * self.peak(light).max(f32::MIN_POSITIVE));
        let light = self.smoothed(light);
        let cells = self.cells();
        Some(Planes::from_fn(samples.len(), |i| {
            let row = self.row[samples.taps.nearest(i)] as usize;
            let normal = Vec3::from_array(samples.normal.sample(i, 0));
            let view = Vec3::from_array(samples.view.sample(i, 0));
            let from = self.sky.nearness * self.places[row];
            let open = &open.rows[row * cells..(row + 1) * cells];
            let cells = open.iter().zip(&centres).zip(&light).filter(|((open, _), _)| **open > 0.0);
            let sum: f32 = cells
                .map(|((open, centre), light)| {
                    open * light * reflected(normal, view, (*centre - from).normalize())
                })
                .sum();
            [scale * sum]
        }))
    }

    /// The luminance of a light through a lobe of 20 degrees: finer than that, diffuse shading does
    /// not tell of it.
    fn smoothed(&self, light: &[f32]) -> Vec<f32> {
        let rays = self.sky.rays(1, 0);
        let centres = self.sky.centres();
        let light = super::luminances(light);
        let smooth = |centre: &Vec3| {
            let (mut sum, mut total) = (0.0, 0.0);
            for ((other, ray), light) in centres.iter().zip(&rays).zip(&light) {
                let weight = ray.solid_angle * centre.dot(*other).max(0.0).powi(LOBE);
                sum += weight * light;
                total += weight;
            }
            sum / total
        };
        centres.par_iter().map(smooth).collect()
    }
}

/// Two GGX lobes with Schlick's term, times the cosine of the light.
fn reflected(normal: Vec3, view: Vec3, light: Vec3) -> f32 {
    let (towards_view, towards_light) = (normal.dot(view).max(GRAZING), normal.dot(light));
    if towards_light <= 0.0 {
        return 0.0;
    }
    let half = (view + light).normalize();
    let cosine = normal.dot(half);
    let lobe = |(alpha, share): (f32, f32)| {
        let squared = alpha * alpha;
        let smith = |c: f32| 2.0 * c / (c + (squared + (1.0 - squared) * c * c).sqrt());
        let spread = cosine * cosine * (squared - 1.0) + 1.0;
        let density = squared * std::f32::consts::FRAC_1_PI / (spread * spread);
        share * density * smith(towards_view) * smith(towards_light)
    };
    LOBES.into_iter().map(lobe).sum::<f32>() / (4.0 * towards_view) * schlick(F0, view.dot(half))
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;

    /// What of an even light of radiance 1 is reflected to a view.
    fn under_a_dome(cosine: f32) -> f32 {
        let view = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
        let (rings, sectors) = (400, 400);
        let mut sum = 0.0;
        for ring in 0..rings {
            let z = (ring as f32 + 0.5) / rings as f32;
            for sector in 0..sectors {
                let (sine, cosine) = (2.0 * PI * (sector as f32 + 0.5) / sectors as f32).sin_cos();
                let radius = (1.0 - z * z).sqrt();
                sum += reflected(Vec3::Z, view, Vec3::new(radius * cosine, radius * sine, z));
            }
        }
        sum * 2.0 * PI / (rings * sectors) as f32
    }

    #[test]
    fn skin_reflects_its_reflectance_from_the_front_and_more_at_a_slant_but_never_all() {
        let front = under_a_dome(1.0);
        // Light that meets facets twice is not followed: a tenth is lost.
        assert!((0.88..1.0).contains(&(front / F0)), "{front}");
        let slanting = under_a_dome(0.3);
        assert!(slanting > 2.0 * front, "{slanting} against {front}");
        assert!((1..10).all(|tenth| under_a_dome(0.1 * tenth as f32) < 1.0));
    }

    #[test]
    fn light_and_view_can_be_exchanged() {
        let (a, b) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.2, 0.4, 0.9).normalize());
        // The value holds the cosine of the light.
        let (there, back) = (reflected(Vec3::Z, a, b) / b.z, reflected(Vec3::Z, b, a) / a.z);
        assert!((there - back).abs() < 1e-5 * there, "{there} {back}");
    }
}
