//! A test of whether a picture holds the whole head, by its mask.

use formats::picture::GrayImage;

/// Share of a side that a mask may touch where the head is whole.
const TOUCHED: f32 = 0.01;

/// Width of a neck that the picture cuts, over that of the head.
const NECK: f32 = 0.8;

/// Returns whether the mask touches no side of the picture, but for a neck at one of them; false for an empty mask.
pub(super) fn shows_whole_head(mask: &GrayImage) -> bool {
    let (width, height) = (mask.width, mask.height);
    let inside = |x: usize, y: usize| mask.data[y * width + x] > 127;
    let row = |y: usize| (0..width).filter(|x| inside(*x, y)).count();
    let column = |x: usize| (0..height).filter(|y| inside(x, *y)).count();
    let (widest, highest) = ((0..height).map(row).max(), (0..width).map(column).max());
    let (Some(widest @ 1..), Some(highest)) = (widest, highest) else { return false };
    // How much of each side is touched, that side's length, and the head's extent along it.
    let mut sides = [
        (row(0), width, widest),
        (row(height - 1), width, widest),
        (column(0), height, highest),
        (column(width - 1), height, highest),
    ];
    sides.sort_by_key(|(touched, ..)| *touched);
    let [others @ .., (touched, _, extent)] = sides;
    let free = |(touched, length, _): (usize, usize, usize)| {
        touched as f32 <= (TOUCHED * length as f32).max(1.0)
    };
    others.into_iter().all(free) && touched as f32 <= NECK * extent as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disc for a head with a neck below it, in a picture whose centre is off by `right` and `down`.
    fn mask(right: f32, down: f32) -> GrayImage {
        let inside = |at: usize| {
            let (x, y) = ((at % 100) as f32 - 50.0 - right, (at / 100) as f32 - 50.0 - down);
            u8::from(x * x + y * y < 900.0 || (x.abs() < 15.0 && y > 0.0)) * 255
        };
        GrayImage { width: 100, height: 100, data: (0..10_000).map(inside).collect() }
    }

    #[test]
    fn a_head_is_whole_with_its_neck_cut_and_not_where_a_side_cuts_it() {
        assert!(shows_whole_head(&mask(0.0, 0.0)));
        for (right, down) in [(35.0, 0.0), (-35.0, 0.0), (0.0, -35.0), (0.0, 45.0)] {
            assert!(!shows_whole_head(&mask(right, down)), "{right}, {down}");
        }
        assert!(!shows_whole_head(&GrayImage::new(9, 9)), "nothing is not a head");
    }
}
