//! Selections of samples.

/// The indices of selected samples, ascending.
#[derive(Clone, Debug)]
pub struct Kept(Vec<usize>);

impl Kept {
    /// Selects every n-th run of `run` of the `samples`, with the least n that leaves about `count` of them. Long runs
    /// keep the samples of a texel together.
    pub fn spread(count: usize, samples: usize, run: usize) -> Self {
        let step = samples.div_ceil(count.max(1)).max(1);
        Self::those(samples, |i| (i / run).is_multiple_of(step))
    }

    /// Selects the samples with a property.
    pub fn those(samples: usize, has_property: impl Fn(usize) -> bool) -> Self {
        Self((0..samples).filter(|i| has_property(*i)).collect())
    }

    /// The number of selected samples.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether no sample is selected.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The number of selected samples among the first `samples`.
    pub fn before(&self, samples: usize) -> usize {
        self.0.partition_point(|i| *i < samples)
    }

    /// The index of the selected sample `i` among all samples.
    pub fn source(&self, i: usize) -> usize {
        self.0[i]
    }

    /// The values of the selected samples.
    pub fn of<T: Copy>(&self, values: &[T]) -> Vec<T> {
        self.0.iter().map(|i| values[*i]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_stay_whole_and_are_spread_evenly() {
        let values: Vec<usize> = (0..23).collect();
        let spread = |count, run| Kept::spread(count, values.len(), run).of(&values);
        assert_eq!(spread(8, 1), [0, 3, 6, 9, 12, 15, 18, 21]);
        assert_eq!(spread(8, 2), [0, 1, 6, 7, 12, 13, 18, 19]);
        assert_eq!(spread(12, 4), [0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19]);
        assert_eq!(spread(100, 4), values);
    }

    #[test]
    fn samples_with_a_property_are_selected() {
        let kept = Kept::those(10, |i| i % 4 == 1);
        assert_eq!([kept.source(0), kept.source(2), kept.len()], [1, 9, 3]);
        assert_eq!([0, 1, 2, 9, 10].map(|samples| kept.before(samples)), [0, 0, 1, 2, 3]);
    }
}
