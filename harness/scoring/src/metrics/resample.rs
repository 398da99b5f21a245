//! Maps of another size.

use formats::picture::Picture;

/// Samples a map bilinearly at the texel centres of another size, clamped at the border.
pub fn resample(map: &Picture, width: usize, height: usize) -> Picture {
    if (map.width, map.height) == (width, height) {
        return map.clone();
    }
    let columns: Vec<_> = (0..width).map(|x| taps(x, map.width, width)).collect();
    let mut target = Picture::new(width, height, map.channels);
    for y in 0..height {
        let (top, bottom, down) = taps(y, map.height, height);
        for (x, &(left, right, along)) in columns.iter().enumerate() {
            for c in 0..map.channels {
                let mix = |y| {
                    let (a, b) = (map.pixel(left, y)[c], map.pixel(right, y)[c]);
                    a + (b - a) * along
                };
                let (a, b) = (mix(top), mix(bottom));
                target.pixel_mut(x, y)[c] = a + (b - a) * down;
            }
        }
    }
    target
}

/// The two source texels around the centre of texel `i`, and how far it lies towards the second.
fn taps(i: usize, from: usize, to: usize) -> (usize, usize, f32) {
    let place = ((i as f64 + 0.5) * from as f64 / to as f64 - 0.5).clamp(0.0, (from - 1) as f64);
    let low = place as usize;
    (low, (low + 1).min(from - 1), (place - low as f64) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_stays_a_ramp_and_halving_averages() {
        let ramp = Picture { width: 4, height: 1, channels: 1, data: vec![0.0, 1.0, 2.0, 3.0] };
        let fine = resample(&ramp, 8, 1);
        let expected = [0.0, 0.25, 0.75, 1.25, 1.75, 2.25, 2.75, 3.0];
        assert!(fine.data.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{fine:?}");
        assert_eq!(resample(&ramp, 2, 1).data, [0.5, 2.5]);
    }
}
