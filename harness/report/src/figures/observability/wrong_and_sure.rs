//! Texels with the largest errors and yet a high confidence.

use scoring::metrics::upper_half;

use super::errors::Errors;
use crate::tone::Field;

/// The share of the texels with the greatest error that count as wrong.
const WRONG: f64 = 0.1;
/// The field's value at a wrong texel whose confidence is in the lower half.
const UNSURE: f32 = 0.4;

pub(super) struct WrongAndSure {
    /// The share of the wrong texels that is sure: a half if the confidence says nothing, none if it says all.
    pub share: f64,
    /// 0 where the method is not wrong, 1 where it is and is sure, between where it is not sure.
    pub field: Field,
}

impl WrongAndSure {
    /// Finds the wrong and confident texels; `None` without a confidence map.
    pub fn of(found: &Errors) -> Option<Self> {
        let confidence = found.confidence.as_ref()?;
        let errors = &found.albedo.values;
        let mut compared: Vec<usize> =
            (0..errors.len()).filter(|at| !errors[*at].is_nan()).collect();
        let values: Vec<f64> = compared.iter().map(|at| f64::from(confidence.data[*at])).collect();
        let mut sure = vec![0.0; errors.len()];
        compared.iter().zip(upper_half(&values)).for_each(|(at, weight)| sure[*at] = weight);
        compared.sort_by(|a, b| errors[*b].total_cmp(&errors[*a]));
        compared.truncate((WRONG * compared.len() as f64).ceil() as usize);
        let mut field = Field { values: errors.clone(), ..found.albedo };
        field.values.iter_mut().filter(|error| !error.is_nan()).for_each(|error| *error = 0.0);
        for at in &compared {
            field.values[*at] = UNSURE + (1.0 - UNSURE) * sure[*at] as f32;
        }
        let share = compared.iter().map(|at| sure[*at]).sum::<f64>() / compared.len().max(1) as f64;
        Some(Self { share, field })
    }
}

#[cfg(test)]
mod tests {
    use formats::picture::Picture;

    use super::*;

    fn share(confidence: impl Fn(usize) -> f32) -> f64 {
        // 100 texels whose error grows, and one that is not compared.
        let mut values: Vec<f32> = (0..100).map(|at| at as f32 * 1e-3).collect();
        values.push(f32::NAN);
        let data = (0..101).map(confidence).collect();
        let found = Errors {
            name: String::new(),
            title: String::new(),
            albedo: Field { width: 101, height: 1, values },
            normal: None,
            confidence: Some(Picture { width: 101, height: 1, channels: 1, data }),
        };
        let wrong = WrongAndSure::of(&found).unwrap();
        assert!(wrong.field.values[100].is_nan() && wrong.field.values[89] == 0.0);
        assert!(wrong.field.values[90..100].iter().all(|value| *value >= UNSURE));
        wrong.share
    }

    #[test]
    fn confidence_that_falls_with_the_error_leaves_nothing_sure_and_a_constant_one_half() {
        assert_eq!(share(|at| 1.0 - at as f32 / 101.0), 0.0);
        assert_eq!(share(|at| at as f32 / 101.0), 1.0);
        assert!((share(|_| 0.7) - 0.5).abs() < 1e-9);
    }
}
