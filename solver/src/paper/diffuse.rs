//! The diffuse albedo under the networks' shading (section 4.3.2).

use super::fields::ShadingFields;
use crate::backend::Backend;
use crate::config::PaperConfig;
use crate::fit::adam::Adam;
use crate::fit::albedo::{AlbedoFit, AlbedoSteps};
use crate::model::deviation::Deviation;
use crate::model::planes::Planes;
use crate::model::samples::Samples;

/// The diffuse albedo alone, with frozen networks, normals and specular albedo.
pub fn diffuse<'a>(
    config: &PaperConfig,
    samples: &'a Samples,
    deviation: &Deviation,
    fields: &ShadingFields,
    backend: &dyn Backend,
) -> AlbedoFit<'a> {
    let layers = fields.layers(samples, deviation, backend);
    let shading = Planes::from_fn(samples.len(), |i| {
        let [diffuse, specular] = layers.sample(i, 0);
        [diffuse, diffuse, diffuse, specular]
    });
    let f = &config.fine_tuning;
    let minimum = config.minimum_albedo();
    let steps = AlbedoSteps { iterations: f.iterations, prior_weight: f.prior, minimum };
    let adam = Adam::new(&config.adam, f.diffuse_rate, fields.diffuse.len());
    AlbedoFit::new(steps, adam, samples, &shading, fields.diffuse.clone())
}
