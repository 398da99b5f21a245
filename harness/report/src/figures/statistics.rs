//! Means over faces with their intervals.

use scoring::study::interval;

use super::drawing::Line;

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
    Some(Mean { value, interval: interval(&means), faces: count })
}

/// A curve of the means over faces in each of the `bins`; `points` gives the face, x and y of the points of a bin.
pub(super) fn curve(
    name: &str,
    bins: impl Iterator<Item = usize>,
    points: impl Fn(usize) -> Vec<(String, f64, f64)>,
) -> Line {
    let mut line = Line { name: name.to_owned(), x: vec![], y: vec![], interval: vec![] };
    for bin in bins {
        let points = points(bin).into_iter();
        let pairs = points.map(|(face, x, y)| ((face.clone(), x), (face, y)));
        let (x, y): (Vec<_>, Vec<_>) = pairs.unzip();
        if let (Some(x), Some(y)) = (over_faces(&x), over_faces(&y)) {
            line.x.push(x.value);
            line.y.push(y.value);
            line.interval.push(y.interval);
        }
    }
    line
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
