//! From deviations to the directions that the kernels see, and back (section 4.3.2).
//!
//! n_s = normalize(n + d), r = 2 (n_s.v) n_s - v; n_d = normalize(n + blur(d)).

use glam::Vec3;

use super::planes::Planes;
use super::samples::Samples;
use crate::config::NetworkConfig;

/// Rows of the directions: scaled diffuse normal, then scaled reflected direction.
pub const DIRECTIONS: usize = 6;

/// Scales of the two directional inputs.
#[derive(Clone, Copy, Debug)]
pub struct DirectionScale {
    /// On the diffuse normal.
    pub normal: f32,
    /// On the reflected direction.
    pub reflection: f32,
}

impl From<&NetworkConfig> for DirectionScale {
    fn from(config: &NetworkConfig) -> Self {
        Self { normal: config.normal_scale, reflection: config.reflection_scale }
    }
}

impl DirectionScale {
    /// Directions of every sample. `deviation` has the rows d (3) and blur(d) (3), and maybe more;
    /// without it, the mesh normal serves for both.
    pub fn directions(&self, samples: &Samples, deviation: Option<&Planes>) -> Planes {
        Planes::from_fn(samples.len(), |i| {
            let [d, b] = deviation.map_or([Vec3::ZERO; 2], |planes| split(planes.sample(i, 0)));
            let normal = Vec3::from_array(samples.normal.sample(i, 0));
            let view = Vec3::from_array(samples.view.sample(i, 0));
            let specular = (normal + d).normalize();
            let reflected = 2.0 * specular.dot(view) * specular - view;
            let diffuse = (normal + b).normalize() * self.normal;
            join(diffuse, reflected * self.reflection)
        })
    }

    /// Carries gradients of the directions (the first six rows of `gradient`) to the deviation and
    /// its blur.
    pub fn adjoint(&self, samples: &Samples, deviation: &Planes, gradient: &Planes) -> Planes {
        Planes::from_fn(samples.len(), |i| {
            let [d, b] = split(deviation.sample(i, 0));
            let [by_diffuse, by_reflected] = split(gradient.sample(i, 0));
            let normal = Vec3::from_array(samples.normal.sample(i, 0));
            let view = Vec3::from_array(samples.view.sample(i, 0));
            let specular = (normal + d).normalize();
            let g = by_reflected * self.reflection;
            let by_specular = 2.0 * (specular.dot(g) * view + specular.dot(view) * g);
            let by_d = normalize_adjoint(normal + d, by_specular);
            let by_b = normalize_adjoint(normal + b, by_diffuse * self.normal);
            join(by_d, by_b)
        })
    }
}

fn split(rows: [f32; 6]) -> [Vec3; 2] {
    [Vec3::from_slice(&rows[..3]), Vec3::from_slice(&rows[3..])]
}

fn join(a: Vec3, b: Vec3) -> [f32; 6] {
    [a.x, a.y, a.z, b.x, b.y, b.z]
}

fn normalize_adjoint(vector: Vec3, gradient: Vec3) -> Vec3 {
    let length = vector.length();
    let unit = vector / length;
    (gradient - unit * unit.dot(gradient)) / length
}
