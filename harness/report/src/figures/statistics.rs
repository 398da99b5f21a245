//! Means over faces with their intervals.

/// Student's t at 97.5 %, for 1 to 30 degrees of freedom (Abramowitz and Stegun, table 26.10).
const T: [f64; 30] = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160,
    2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056,
    2.052, 2.048, 2.045, 2.042,
];

/// Mean and 95 % interval of values, one per face. Faces are the unit: what one face's cases give is averaged
/// first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mean {
    pub value: f64,
    /// Student's t over the faces; none of fewer than two.
    pub interval: Option<[f64; 2]>,
    pub faces: usize,
}

/// The mean over faces of `(face, value)`; none of nothing.
pub(super) fn over_faces(values: &[(String, f64)]) -> Option<Mean> {
    let mut faces: Vec<(&str, f64, f64)> = Vec::new();
    for (face, value) in values {
        match faces.iter_mut().find(|(known, ..)| known == face) {
            Some((_, sum, count)) => {
                *sum += value;
                *count += 1.0;
            }
            None => faces.push((face, *value, 1.0)),
        }
    }
    let means: Vec<f64> = faces.iter().map(|(_, sum, count)| sum / count).collect();
    let count = means.len();
    if count == 0 {
        return None;
    }
    let value = means.iter().sum::<f64>() / count as f64;
    let interval = (count > 1).then(|| {
        let squares: f64 = means.iter().map(|mean| (mean - value).powi(2)).sum();
        let error = (squares / (count - 1) as f64 / count as f64).sqrt();
        let half = T.get(count - 2).copied().unwrap_or(1.96) * error;
        [value - half, value + half]
    });
    Some(Mean { value, interval, faces: count })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_are_the_unit_and_the_interval_is_that_of_a_textbook() {
        let value = |face: &str, value: f64| (face.to_owned(), value);
        // Two cases of one face count as one value.
        let found =
            over_faces(&[value("a", 1.0), value("a", 3.0), value("b", 4.0), value("c", 6.0)])
                .unwrap();
        // 2, 4, 6: mean 4, standard deviation 2, error 2 / sqrt 3, times 4.303.
        assert_eq!((found.value, found.faces), (4.0, 3));
        let [low, high] = found.interval.unwrap();
        assert!((high - 4.0 - 4.969).abs() < 1e-3 && (4.0 - low - 4.969).abs() < 1e-3);
        assert_eq!(over_faces(&[value("a", 1.0)]).unwrap().interval, None);
        assert_eq!(over_faces(&[]), None);
    }
}
