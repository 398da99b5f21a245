//! Normals and specular albedo (section 4.3.2).

use serde::{Deserialize, Serialize};

use super::fields::ShadingFields;
use crate::backend::resident::{Job, NormalsJob, Variable};
use crate::backend::{Backend, TexturedNormals};
use crate::config::PaperConfig;
use crate::fit::Fit;
use crate::fit::adam::Adam;
use crate::model::deviation::{Deviation, TextureGradients};
use crate::model::networks::Networks;
use crate::model::planes::Planes;
use crate::model::samples::Samples;

/// The parameters of [`Normals`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Relief {
    /// See [`ShadingFields::deviation`].
    pub deviation: Vec<f32>,
    /// See [`ShadingFields::specular`].
    pub specular: Vec<f32>,
}

/// The fit of specular albedo and deviation, with frozen networks and diffuse albedo.
pub struct Normals<'a> {
    /// The parameters.
    pub relief: Relief,
    config: &'a PaperConfig,
    samples: &'a Samples,
    deviation: &'a Deviation,
    networks: &'a Networks,
    light: Planes,
    albedo: Planes,
    deviation_adam: Adam,
    specular_adam: Adam,
}

impl<'a> Normals<'a> {
    /// Starts from these fields; L(p) and the diffuse albedo are evaluated once.
    pub fn new(
        config: &'a PaperConfig,
        samples: &'a Samples,
        deviation: &'a Deviation,
        fields: &'a ShadingFields,
        backend: &dyn Backend,
    ) -> Self {
        let (f, adam) = (&config.fine_tuning, &config.adam);
        Self {
            relief: Relief {
                deviation: fields.deviation.clone(),
                specular: fields.specular.clone(),
            },
            config,
            samples,
            deviation,
            networks: &fields.networks,
            light: backend.light(&fields.networks, &samples.position),
            albedo: fields.albedo(samples),
            deviation_adam: Adam::new(adam, f.deviation_rate, fields.deviation.len()),
            specular_adam: Adam::new(adam, f.specular_rate, fields.specular.len()),
        }
    }
}

impl Fit for Normals<'_> {
    fn iterations(&self) -> usize {
        self.config.fine_tuning.iterations
    }

    fn gradient(&self, backend: &dyn Backend) -> (f64, Vec<Vec<f32>>) {
        let textures = self.deviation.packed(&self.relief.deviation, &self.relief.specular);
        let textured = TexturedNormals {
            networks: self.networks,
            samples: self.samples,
            light: &self.light,
            albedo: &self.albedo,
            scale: &self.deviation.scale,
            textures: &textures,
        };
        let (loss, gradient) = backend.deviation_gradient(&textured);
        let TextureGradients { deviation, specular } = self.deviation.adjoint(&textures, &gradient);
        (loss, vec![deviation, specular])
    }

    fn job(&self) -> Option<Job<'_>> {
        Some(Job::Normals(NormalsJob {
            samples: self.samples,
            deviation: self.deviation,
            networks: self.networks,
            light: &self.light,
            albedo: &self.albedo,
        }))
    }

    fn variables(&mut self) -> Vec<Variable<'_>> {
        let (free, minimum) = (f32::NEG_INFINITY, self.config.minimum_albedo());
        vec![
            Variable::new(&mut self.relief.deviation, &mut self.deviation_adam, free),
            Variable::new(&mut self.relief.specular, &mut self.specular_adam, minimum),
        ]
    }
}
