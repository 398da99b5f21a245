//! From solved to physical albedos (section 5.4).

use crate::config::NormalisationConfig;
use crate::maps::Scales;

/// The factors on the solved albedos. Pictures are exposed so that the largest irradiance is pi; a Lambert
/// reflectance rho then shows as rho E / pi = A S_d, so that rho is A times the largest S_d. The specular albedo is
/// scaled so that its upper end is that of human skin. `shading` is S_d of all training samples, `specular` the
/// specular albedo of all covered texels.
pub(super) fn scales(
    config: &NormalisationConfig,
    shading: Vec<f32>,
    specular: Vec<f32>,
) -> Scales {
    let top = percentile(specular, config.specular_percentile);
    Scales {
        diffuse: percentile(shading, config.diffuse_percentile),
        specular: if top > 0.0 { config.specular_maximum / top } else { 0.0 },
    }
}

/// The value below which `percent` of the values lie, interpolated; 0 without values.
fn percentile(mut values: Vec<f32>, percent: f64) -> f32 {
    values.sort_by(f32::total_cmp);
    let Some(last) = values.len().checked_sub(1) else { return 0.0 };
    let place = percent / 100.0 * last as f64;
    let low = values[place as usize];
    let high = values[(place as usize + 1).min(last)];
    low + (high - low) * place.fract() as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PaperConfig;

    #[test]
    fn percentiles_interpolate_and_hundred_is_the_maximum() {
        let values = vec![3.0, 1.0, 2.0, 5.0];
        assert_eq!(percentile(values.clone(), 100.0), 5.0);
        assert_eq!(percentile(values.clone(), 50.0), 2.5);
        assert_eq!(percentile(vec![], 50.0), 0.0);
        let config = PaperConfig::default().normalisation;
        assert_eq!(scales(&config, values, vec![0.1]), Scales { diffuse: 5.0, specular: 0.5 });
        assert_eq!(scales(&config, vec![1.0], vec![0.0]).specular, 0.0);
    }
}
