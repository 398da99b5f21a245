//! Order statistics of pixels: ranks, and who is in the upper half.

/// Ranks from 0, ties sharing their mean rank.
pub(super) fn ranks(values: &[f64]) -> Vec<f64> {
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for_ties(values, |ties| {
        let mean = first as f64 + (ties.len() - 1) as f64 / 2.0;
        ties.iter().for_each(|i| ranks[*i] = mean);
        first += ties.len();
    });
    ranks
}

/// The weight of each value in the upper half: 1 above the median, 0 below; those
/// that tie for the last places share them, so that the order of equal values does not matter.
pub fn upper_half(values: &[f64]) -> Vec<f64> {
    let mut weights = vec![0.0; values.len()];
    let half = values.len() as f64 / 2.0;
    let mut below = 0;
    for_ties(values, |ties| {
        below += ties.len();
        let above = (values.len() - below) as f64;
        let weight = ((half - above) / ties.len() as f64).clamp(0.0, 1.0);
        ties.iter().for_each(|i| weights[*i] = weight);
    });
    weights
}

/// Groups of equal values in ascending order.
fn for_ties(values: &[f64], mut each: impl FnMut(&[usize])) {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    order.chunk_by(|a, b| values[*a] == values[*b]).for_each(&mut each);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_upper_half_holds_half_of_all_and_ties_share_its_last_places() {
        assert_eq!(upper_half(&[4.0, 1.0, 3.0, 2.0]), [1.0, 0.0, 1.0, 0.0]);
        assert_eq!(upper_half(&[3.0, 1.0, 2.0]), [1.0, 0.0, 0.5]);
        assert_eq!(upper_half(&[5.0, 2.0, 2.0, 2.0, 2.0, 1.0]), [1.0, 0.5, 0.5, 0.5, 0.5, 0.0]);
        assert_eq!(upper_half(&[7.0; 4]), [0.5; 4]);
        assert_eq!(ranks(&[7.0, 1.0, 7.0]), [1.5, 0.0, 1.5]);
    }
}
