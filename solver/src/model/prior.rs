//! The albedo prior, equation (2): piecewise constancy.

use rayon::prelude::*;

/// Channels of the diffuse albedo.
const CHANNELS: usize = 3;

/// `weight` times the average over texels and channels of sqrt(1 + |du A|) - 1 + sqrt(1 + |dv A|)
/// - 1 with differences to the next texel; its gradient is added to `gradient`.
pub fn prior(albedo: &[f32], size: usize, weight: f32, gradient: &mut [f32]) -> f64 {
    if weight == 0.0 {
        return 0.0;
    }
    let line = size * CHANNELS;
    let scale = weight / albedo.len() as f32;
    let row = |(y, gradient): (usize, &mut [f32])| {
        let mut sum = 0.0;
        for (x, gradient) in gradient.iter_mut().enumerate() {
            let at = y * line + x;
            let value = albedo[at];
            if x + CHANNELS < line {
                sum += penalty(albedo[at + CHANNELS] - value);
                *gradient -= scale * slope(albedo[at + CHANNELS] - value);
            }
            if x >= CHANNELS {
                *gradient += scale * slope(value - albedo[at - CHANNELS]);
            }
            if y + 1 < size {
                sum += penalty(albedo[at + line] - value);
                *gradient -= scale * slope(albedo[at + line] - value);
            }
            if y > 0 {
                *gradient += scale * slope(value - albedo[at - line]);
            }
        }
        sum
    };
    let sums: Vec<f64> = gradient.par_chunks_mut(line).enumerate().map(row).collect();
    f64::from(weight) * sums.iter().sum::<f64>() / albedo.len() as f64
}

fn penalty(difference: f32) -> f64 {
    f64::from((1.0 + difference.abs()).sqrt() - 1.0)
}

/// Derivative of the penalty; zero where it has none.
fn slope(difference: f32) -> f32 {
    if difference == 0.0 {
        return 0.0;
    }
    (0.5 / (1.0 + difference.abs()).sqrt()).copysign(difference)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture() -> Vec<f32> {
        (0..5 * 5 * 3).map(|i| (i as f32 * 1.7).sin()).collect()
    }

    #[test]
    fn the_value_is_the_formula_written_out() {
        let albedo = texture();
        let at = |x: usize, y: usize, c: usize| f64::from(albedo[(y * 5 + x) * 3 + c]);
        let mut sum = 0.0;
        for y in 0..5 {
            for x in 0..5 {
                for c in 0..3 {
                    let mut add = |d: f64| sum += (1.0 + d.abs()).sqrt() - 1.0;
                    if x < 4 {
                        add(at(x + 1, y, c) - at(x, y, c));
                    }
                    if y < 4 {
                        add(at(x, y + 1, c) - at(x, y, c));
                    }
                }
            }
        }
        let value = prior(&albedo, 5, 0.3, &mut vec![0.0; albedo.len()]);
        assert!((value - 0.3 * sum / 75.0).abs() < 1e-8, "{value}");
    }

    #[test]
    fn the_gradient_matches_central_differences() {
        let albedo = texture();
        let mut gradient = vec![0.0; albedo.len()];
        prior(&albedo, 5, 10.0, &mut gradient);
        for at in [0, 17, 36, 74] {
            let value = |step: f32| {
                let mut moved = albedo.clone();
                moved[at] += step;
                prior(&moved, 5, 10.0, &mut vec![0.0; albedo.len()])
            };
            let numeric = (value(1e-2) - value(-1e-2)) / 2e-2;
            // The step is far from every kink of this texture; f32 leaves about 1e-4.
            assert!((numeric - f64::from(gradient[at])).abs() < 5e-4, "{numeric} {}", gradient[at]);
        }
    }
}
