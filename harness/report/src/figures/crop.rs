//! The part of a picture that shows the head, by the mask of the face.

use formats::picture::{GrayImage, Picture};

/// Room around the face, as a share of its extent: at the sides and below.
const MARGIN: f32 = 0.08;
/// Above: masks end where the scored skin ends, below the crown.
const ABOVE: f32 = 0.25;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Crop {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
}

impl Crop {
    /// The foreground with its margins; none for an empty mask.
    pub fn around(mask: &GrayImage) -> Option<Self> {
        let inside = (0..mask.data.len()).filter(|at| mask.data[*at] > 127);
        let places = inside.map(|at| [at % mask.width, at / mask.width]);
        let (low, high) = places.fold(None, |ends, place| {
            let (low, high) = ends.unwrap_or((place, place));
            let per_axis = |pick: fn(usize, usize) -> usize, with: [usize; 2]| {
                [pick(with[0], place[0]), pick(with[1], place[1])]
            };
            Some((per_axis(usize::min, low), per_axis(usize::max, high)))
        })?;
        let extent = [high[0] + 1 - low[0], high[1] + 1 - low[1]];
        let share = |part: f32, axis: usize| (part * extent[axis] as f32) as usize;
        let left = low[0].saturating_sub(share(MARGIN, 0));
        let top = low[1].saturating_sub(share(ABOVE, 1));
        let right = (high[0] + 1 + share(MARGIN, 0)).min(mask.width);
        let bottom = (high[1] + 1 + share(MARGIN, 1)).min(mask.height);
        Some(Self { left, top, width: right - left, height: bottom - top })
    }

    /// This part of a picture as large as the mask was; another stays whole.
    pub fn of(&self, picture: Picture) -> Picture {
        let Self { left, top, width, height } = *self;
        if left + width > picture.width || top + height > picture.height {
            return picture;
        }
        let channels = picture.channels;
        let row = |y: usize| {
            &picture.data[((top + y) * picture.width + left) * channels..][..width * channels]
        };
        let data = (0..height).flat_map(|y| row(y).iter().copied()).collect();
        Picture { width, height, channels, data }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_face_is_cut_out_with_room_above_it() {
        let inside = |at: usize| (40..60).contains(&(at % 100)) && (50..70).contains(&(at / 100));
        let data = (0..10_000).map(|at| u8::from(inside(at)) * 255).collect();
        let crop = Crop::around(&GrayImage { width: 100, height: 100, data }).unwrap();
        assert_eq!(crop, Crop { left: 39, top: 45, width: 22, height: 26 });
        let ramp = |at: usize| at as f32;
        let picture =
            Picture { width: 100, height: 100, channels: 1, data: (0..10_000).map(ramp).collect() };
        let cut = crop.of(picture);
        assert_eq!((cut.width, cut.height, cut.data[0], cut.data[22]), (22, 26, 4539.0, 4639.0));
        assert_eq!(Crop::around(&GrayImage::new(9, 9)), None, "nothing has no head");
    }
}
