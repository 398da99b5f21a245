//! Smooth continuation of a picture into the places that have no data.

use crate::picture::Picture;

/// Replaces every pixel that is not `known` by averages of known ones, nearer ones first (push and
/// pull through a pyramid of halved pictures). Without any known pixel nothing changes.
pub fn fill(picture: &mut Picture, known: &[bool]) {
    let unknown = known.iter().filter(|known| !**known).count();
    if unknown == 0 || unknown == known.len() {
        return;
    }
    let (width, height, channels) = (picture.width, picture.height, picture.channels);
    let mut half = Picture::new(width.div_ceil(2), height.div_ceil(2), channels);
    let mut count = vec![0u8; half.width * half.height];
    for at in (0..width * height).filter(|at| known[*at]) {
        let target = at / width / 2 * half.width + at % width / 2;
        count[target] += 1;
        for c in 0..channels {
            half.data[target * channels + c] += picture.data[at * channels + c];
        }
    }
    for (pixel, count) in half.data.chunks_exact_mut(channels).zip(&count) {
        pixel.iter_mut().for_each(|value| *value /= f32::from(*count).max(1.0));
    }
    fill(&mut half, &count.iter().map(|count| *count > 0).collect::<Vec<_>>());
    for at in (0..width * height).filter(|at| !known[*at]) {
        bilinear(&half, at % width, at / width, &mut picture.data[at * channels..][..channels]);
    }
}

/// The picture at half the size, interpolated at pixel (x, y) of the full size.
fn bilinear(half: &Picture, x: usize, y: usize, out: &mut [f32]) {
    let axis = |at: usize, size: usize| {
        let place = (at as f32 * 0.5 - 0.25).clamp(0.0, (size - 1) as f32);
        let first = (place as usize).min(size.saturating_sub(2));
        (first, (first + 1).min(size - 1), place - first as f32)
    };
    let ((x0, x1, fx), (y0, y1, fy)) = (axis(x, half.width), axis(y, half.height));
    for (c, out) in out.iter_mut().enumerate() {
        let row = |y| half.pixel(x0, y)[c] * (1.0 - fx) + half.pixel(x1, y)[c] * fx;
        *out = row(y0) * (1.0 - fy) + row(y1) * fy;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_pixels_stay_and_the_rest_lies_between_them() {
        let mut picture = Picture::new(13, 9, 1);
        let mut known = vec![false; 13 * 9];
        for (at, value) in [(0, 1.0), (12, 3.0), (8 * 13, 2.0)] {
            picture.data[at] = value;
            known[at] = true;
        }
        fill(&mut picture, &known);
        assert_eq!((picture.data[0], picture.data[12], picture.data[8 * 13]), (1.0, 3.0, 2.0));
        assert!(picture.data.iter().all(|v| (1.0..=3.0).contains(v)));
        assert!(picture.pixel(11, 1)[0] > picture.pixel(1, 1)[0], "nearer pixels count more");
    }
}
