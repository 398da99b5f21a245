//! The transpose of sampling: gradients of texels from those of samples.

use super::planes::{BLOCK, Planes, Row};
use super::strips::{Strip, blocks};
use super::taps::{Taps, sample_block};

impl Taps {
    /// The adjoint of [`Taps::sample`]: sums the samples' gradients (rows `first..first + C`) into
    /// the texels from which they were interpolated.
    pub fn gather<const C: usize>(&self, gradient: &Planes, first: usize) -> Vec<f32> {
        let rows = |block: usize| gradient.block(block)[first..].first_chunk::<C>();
        let add = |strip: &mut Strip<C>| {
            for (block, lanes) in blocks(strip.samples.clone()) {
                rows(block).into_iter().for_each(|rows| strip.add(block, lanes.clone(), rows));
            }
        };
        self.by_strip(add).0
    }

    /// [`Taps::sample`] and [`Taps::gather`] in one pass, without planes between them. Given the number
    /// of a block and the texture values of its samples, `value` writes their gradients and their
    /// terms of the loss. Returns the texels' gradients and the sum of the terms. (Blocks at the ends
    /// of a strip are seen twice, with other samples valid.)
    pub fn exchange<const C: usize, const D: usize>(
        &self,
        texture: &[f32],
        value: impl Fn(usize, &[Row; C], &mut [Row; D], &mut Row) + Sync,
    ) -> (Vec<f32>, f64) {
        let (texels, _) = texture.as_chunks::<C>();
        let (gradient, sums) = self.by_strip(|strip| {
            let (mut values, mut gradient) = ([Row::ZERO; C], [Row::ZERO; D]);
            let mut loss = Row::ZERO;
            let mut sum = 0.0;
            for (block, lanes) in blocks(strip.samples.clone()) {
                let samples = block * BLOCK + lanes.start..block * BLOCK + lanes.end;
                let (cell, fraction) = (&self.cells()[samples.clone()], &self.fractions()[samples]);
                sample_block(cell, fraction, texels, self.size(), lanes.start, &mut values);
                value(block, &values, &mut gradient, &mut loss);
                sum += loss.0[lanes.clone()].iter().map(|term| f64::from(*term)).sum::<f64>();
                strip.add(block, lanes, &gradient);
            }
            sum
        });
        (gradient, sums.iter().sum())
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::model::kept::Kept;
    use crate::model::planes::CHUNK_BLOCKS;

    fn points(count: usize) -> Vec<Vec2> {
        let noise = |i: usize, k: f32| ((i as f32 + 1.0) * k).sin().abs().fract();
        (0..count).map(|i| Vec2::new(noise(i, 12.9898), noise(i, 78.233))).collect()
    }

    #[test]
    fn thinned_samples_keep_their_places() {
        let (size, step) = (16, 3);
        let taps = Taps::sorted(size, &points(1000)).0;
        let texture: Vec<f32> = (0..size * size).map(|i| (i as f32 * 0.7).sin()).collect();
        let values = taps.sample::<1>(&texture);
        let every = Kept::those(1000, |i| i.is_multiple_of(step));
        let thin = taps.kept(&every);
        assert_eq!(thin.sample::<1>(&texture), values.kept(&every));
        let kept = |i: usize| if i.is_multiple_of(step) { values.get(0, i) } else { 0.0 };
        let kept = Planes::from_fn(1000, |i| [kept(i)]);
        let sums = thin.gather::<1>(&values.kept(&every), 0).into_iter();
        for (sum, expected) in sums.zip(taps.gather::<1>(&kept, 0)) {
            assert!((sum - expected).abs() < 1e-5, "{sum} not {expected}");
        }
    }

    #[test]
    fn gather_is_the_transpose_of_sample() {
        let (taps, _) = Taps::sorted(16, &points(1000));
        let texture: Vec<f32> = (0..16 * 16 * 3).map(|i| (i as f32 * 0.37).sin()).collect();
        let gradient = Planes::from_fn(1000, |i| [1.0, 2.0, 3.0].map(|k| (i as f32 * k).cos()));
        let sampled = taps.sample::<3>(&texture);
        let gathered = taps.gather::<3>(&gradient, 0);
        let left: f64 = (0..1000)
            .flat_map(|i| (0..3).map(move |c| (c, i)))
            .map(|(c, i)| f64::from(sampled.get(c, i)) * f64::from(gradient.get(c, i)))
            .sum();
        let right: f64 =
            gathered.iter().zip(&texture).map(|(g, t)| f64::from(*g) * f64::from(*t)).sum();
        assert!((left - right).abs() < 1e-3 * left.abs().max(1.0), "{left} {right}");
    }

    #[test]
    fn chunks_of_samples_add_up_to_the_strips_sums() {
        // Two chunks, the second one of less than a block, that share a row.
        let count = CHUNK_BLOCKS * BLOCK + 100;
        let (taps, _) = Taps::sorted(16, &points(count));
        let gradient = Planes::from_fn(count, |i| [(i as f32).cos(), 1.0]);
        let add = |(): &mut (), strip: &mut Strip<2>| {
            for (block, lanes) in blocks(strip.samples.clone()) {
                strip.add(block, lanes, gradient.rows_of(block));
            }
            strip.samples.len()
        };
        let (sums, lengths) = taps.by_chunk(|| (), add);
        assert_eq!(lengths, [count - 100, 100]);
        for (sum, expected) in sums.iter().zip(taps.gather::<2>(&gradient, 0)) {
            assert!((sum - expected).abs() < 1e-4 * expected.abs().max(1.0), "{sum} {expected}");
        }
        assert!(Taps::sorted(16, &[]).0.by_chunk(|| (), add).0.iter().all(|sum| *sum == 0.0));
    }

    #[test]
    fn an_exchange_is_a_sample_and_a_gather() {
        // More rows than a strip has.
        let (taps, _) = Taps::sorted(300, &points(5000));
        let texture: Vec<f32> = (0..300 * 300 * 2).map(|i| (i as f32 * 0.37).sin()).collect();
        let swap = |i: usize, [a, b]: [f32; 2]| [b, a * (i % 7) as f32, 1.0];
        let sampled = taps.sample::<2>(&texture);
        let planes = Planes::from_fn(5000, |i| swap(i, sampled.sample(i, 0)));
        let (gathered, sum) = taps.exchange::<2, 3>(&texture, |block, values, gradient, loss| {
            for lane in 0..BLOCK {
                let [a, b, c] = swap(block * BLOCK + lane, [0, 1].map(|c| values[c].0[lane]));
                (gradient[0].0[lane], gradient[1].0[lane], gradient[2].0[lane]) = (a, b, c);
                loss.0[lane] = values[0].0[lane];
            }
        });
        assert_eq!(gathered, taps.gather::<3>(&planes, 0));
        let expected: f64 = (0..5000).map(|i| f64::from(sampled.get(0, i))).sum();
        assert!((sum - expected).abs() < 1e-9, "{sum} {expected}");
    }
}
