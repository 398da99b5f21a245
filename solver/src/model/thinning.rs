//! Which of many samples are kept.

/// Of every `step` runs of `run` samples the first. Long runs keep samples of a texel together.
#[derive(Clone, Copy, Debug)]
pub struct Thinning {
    /// At least 1.
    pub(super) step: usize,
    /// At least 1.
    pub(super) run: usize,
}

impl Thinning {
    /// Of `samples` about `count`, or all.
    pub fn to(count: usize, samples: usize, run: usize) -> Self {
        Self { step: samples.div_ceil(count.max(1)).max(1), run }
    }

    /// How many of the first `samples` are kept.
    pub fn kept(self, samples: usize) -> usize {
        let period = self.step * self.run;
        samples / period * self.run + (samples % period).min(self.run)
    }

    /// The number that the kept sample `i` had.
    pub fn source(self, i: usize) -> usize {
        i / self.run * self.run * self.step + i % self.run
    }

    /// What is kept of `values`.
    pub fn of<T: Copy>(self, values: &[T]) -> Vec<T> {
        (0..self.kept(values.len())).map(|i| values[self.source(i)]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_stay_whole_and_are_spread_evenly() {
        let values: Vec<usize> = (0..23).collect();
        assert_eq!(Thinning { step: 3, run: 1 }.of(&values), [0, 3, 6, 9, 12, 15, 18, 21]);
        assert_eq!(Thinning { step: 3, run: 2 }.of(&values), [0, 1, 6, 7, 12, 13, 18, 19]);
        assert_eq!(
            Thinning { step: 2, run: 4 }.of(&values),
            [0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19]
        );
        assert_eq!(Thinning::to(100, 23, 4).of(&values), values);
    }
}
