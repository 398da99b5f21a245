//! The prior on a smooth colour of the light. Without it, cells that few pixels constrain absorb colour errors of the
//! model.

use super::CHANNELS;

/// Returns `weight` times the sum over neighbouring cells of edge x sum_c (sqrt(d_c^2 + s^2) - s), over the number of
/// cells, and adds its gradient to `gradient`. d_c is the difference of log radiance in channel c, minus its mean over
/// channels; the edge is the length of the common border over that on the equator; s is `softness`, below which
/// differences are hardly penalised. Cells are those of [`super::sky::Sky::lat_long`], R, G, B each.
pub fn light_colour(log_light: &[f32], weight: f32, softness: f32, gradient: &mut [f32]) -> f64 {
    if weight == 0.0 {
        return 0.0;
    }
    let (cells, _) = log_light.as_chunks::<CHANNELS>();
    let rows = (cells.len() / 2).isqrt();
    let columns = 2 * rows;
    let scale = weight / cells.len() as f32;
    let edge = |below: usize| (std::f32::consts::PI * below as f32 / rows as f32).sin();
    let mut sum = 0.0;
    for (at, gradient) in gradient.as_chunks_mut::<CHANNELS>().0.iter_mut().enumerate() {
        let (row, column) = (at / columns, at % columns);
        let line = row * columns;
        let mut pair = |other: usize, edge: f32, counts: bool| {
            let d: [f32; CHANNELS] = std::array::from_fn(|c| cells[at][c] - cells[other][c]);
            let mean = d.iter().sum::<f32>() / CHANNELS as f32;
            let roots = d.map(|d| ((d - mean).powi(2) + softness * softness).sqrt());
            let slopes: [f32; CHANNELS] = std::array::from_fn(|c| (d[c] - mean) / roots[c]);
            let common = slopes.iter().sum::<f32>() / CHANNELS as f32;
            for c in 0..CHANNELS {
                gradient[c] += scale * edge * (slopes[c] - common);
                sum += if counts { f64::from(scale * edge * (roots[c] - softness)) } else { 0.0 };
            }
        };
        pair(line + (column + 1) % columns, 1.0, true);
        pair(line + (column + columns - 1) % columns, 1.0, false);
        if row + 1 < rows {
            pair(at + columns, edge(row + 1), true);
        }
        if row > 0 {
            pair(at - columns, edge(row), false);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light() -> Vec<f32> {
        (0..CHANNELS * 8 * 4).map(|i| (1.7 * i as f32).sin()).collect()
    }

    #[test]
    fn the_gradient_is_that_of_finite_differences() {
        let light = light();
        let mut gradient = vec![0.0; light.len()];
        light_colour(&light, 5.0, 0.3, &mut gradient);
        const STEP: f32 = 1e-2;
        for at in [0, 25, 40, 95] {
            let value = |step: f32| {
                let mut moved = light.clone();
                moved[at] += step;
                light_colour(&moved, 5.0, 0.3, &mut vec![0.0; light.len()])
            };
            let expected = (value(STEP) - value(-STEP)) / f64::from(2.0 * STEP);
            assert!((expected - f64::from(gradient[at])).abs() < 1e-3, "{at}: {expected}");
        }
    }

    #[test]
    fn a_light_of_one_colour_costs_nothing_however_bright_its_lamps_are() {
        let grey: Vec<f32> =
            light().chunks(CHANNELS).flat_map(|cell| [cell[0]; CHANNELS]).collect();
        let mut gradient = vec![0.0; grey.len()];
        assert!(light_colour(&grey, 1.0, 0.3, &mut gradient).abs() < 1e-6);
        assert!(gradient.iter().all(|by| by.abs() < 1e-6));
        assert!(light_colour(&light(), 1.0, 0.3, &mut gradient) > 0.1);
    }
}
