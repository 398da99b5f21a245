//! A map at the size at which it is compared: small enough to be fast, large enough for brows.

use formats::picture::Picture;

/// Side of what is compared, texels.
pub(super) const SIDE: usize = 128;

/// A map of [`SIDE`] by [`SIDE`] texels.
pub(super) struct Reduced {
    pub channels: usize,
    /// Finite wherever `valid`.
    pub data: Vec<f32>,
    /// True if the map has a value there: finite, and not zero in all channels.
    pub valid: Vec<bool>,
}

impl Reduced {
    /// Means over the texels whose centres lie in a cell; of a smaller map the nearest texels.
    pub fn of(map: &Picture) -> Self {
        let Picture { width, height, channels, .. } = *map;
        let mut data = vec![0.0; SIDE * SIDE * channels];
        let mut counts = vec![0_u32; SIDE * SIDE];
        let mut add = |cell: usize, values: &[f32]| {
            if values.iter().all(|v| v.is_finite()) && values.iter().any(|v| *v != 0.0) {
                let sums = &mut data[cell * channels..(cell + 1) * channels];
                sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
                counts[cell] += 1;
            }
        };
        if width < SIDE || height < SIDE {
            for cell in 0..SIDE * SIDE {
                let at = |i: usize, size: usize| (2 * i + 1) * size / (2 * SIDE);
                add(cell, map.pixel(at(cell % SIDE, width), at(cell / SIDE, height)));
            }
        } else {
            for (texel, values) in map.data.chunks_exact(channels).enumerate() {
                let at = |i: usize, size: usize| (2 * i + 1) * SIDE / (2 * size);
                add(at(texel / width, height) * SIDE + at(texel % width, width), values);
            }
        }
        for (sums, count) in data.chunks_exact_mut(channels).zip(&counts) {
            sums.iter_mut().for_each(|sum| *sum /= (*count).max(1) as f32);
        }
        // A sum of huge values may have overflowed.
        let valid = data.chunks_exact(channels).zip(&counts);
        let valid = valid.map(|(v, count)| *count > 0 && v.iter().all(|v| v.is_finite())).collect();
        Self { channels, data, valid }
    }

    /// The values of a texel.
    pub fn texel(&self, texel: usize) -> &[f32] {
        &self.data[texel * self.channels..(texel + 1) * self.channels]
    }
}

/// The value that a share `q` of the finite values lies below; none without any.
pub(super) fn quantile(values: impl Iterator<Item = f32>, q: f64) -> Option<f64> {
    let mut finite: Vec<f32> = values.filter(|value| value.is_finite()).collect();
    let rank = (finite.len().checked_sub(1)? as f64 * q).round() as usize;
    let (_, value, _) = finite.select_nth_unstable_by(rank, f32::total_cmp);
    Some(f64::from(*value))
}

/// The median of the finite values; none without any.
pub(super) fn median(values: impl Iterator<Item = f32>) -> Option<f64> {
    quantile(values, 0.5)
}
