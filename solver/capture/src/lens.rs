//! Lens distortion: taken out of a view when it is opened, so that all cameras are pinholes.

use formats::picture::{GrayImage, Picture};

use super::Camera;

/// Steps between the optical axis and the corner of a picture at which the lens is tested.
const RADIAL_STEPS: usize = 256;
/// Directions in which it is tested.
const DIRECTIONS: usize = 64;

/// Brown's distortion with OpenCV's terms, on film coordinates over focal length, x right, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Distortion {
    /// Radial, r².
    pub k1: f64,
    /// Radial, r⁴.
    pub k2: f64,
    /// Tangential.
    pub p1: f64,
    /// Tangential.
    pub p2: f64,
}

/// The pictures of a view.
pub(super) struct Layers {
    /// See [`super::View::image`].
    pub image: Picture,
    /// See [`super::View::mask`].
    pub mask: GrayImage,
    /// See [`super::View::labels`].
    pub labels: Option<GrayImage>,
}

impl Distortion {
    /// The distorted position of the pinhole position `[x, y]`.
    pub fn distort(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let Self { k1, k2, p1, p2 } = *self;
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (k1 + r2 * k2);
        [
            x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
        ]
    }

    /// The radius, at most `corner`, up to which the lens shows every direction once. Beyond it
    /// the polynomial folds back, which no real lens does.
    fn reach(&self, corner: f64) -> f64 {
        let Self { k1, k2, p1, p2 } = *self;
        let unfolded = |x: f64, y: f64| {
            let r2 = x * x + y * y;
            let (radial, slope) = (1.0 + r2 * (k1 + r2 * k2), 2.0 * (k1 + 2.0 * k2 * r2));
            let a = radial + slope * x * x + 2.0 * p1 * y + 6.0 * p2 * x;
            let b = slope * x * y + 2.0 * p1 * x + 2.0 * p2 * y;
            let d = radial + slope * y * y + 6.0 * p1 * y + 2.0 * p2 * x;
            // The Jacobian is symmetric; positive, it makes the map one to one.
            a > 0.0 && a * d > b * b
        };
        let ring = |step: usize| corner * step as f64 / RADIAL_STEPS as f64;
        let fine = |step: usize| {
            (0..DIRECTIONS).all(|index| {
                let angle = std::f64::consts::TAU * index as f64 / DIRECTIONS as f64;
                unfolded(ring(step) * angle.cos(), ring(step) * angle.sin())
            })
        };
        let last = (1..=RADIAL_STEPS).take_while(|step| fine(*step)).last();
        last.map_or(0.0, ring)
    }

    /// The layers as the pinhole `camera` would have taken them: the picture interpolated
    /// bilinearly, mask and labels from the nearest pixel. Where the lens saw nothing, the
    /// picture is black and the mask empty.
    pub fn undistort(&self, camera: &Camera, taken: &Layers) -> Layers {
        let image = &taken.image;
        let (width, height) = (camera.width, camera.height);
        let mut result = Layers {
            image: Picture::new(width, height, image.channels),
            mask: GrayImage::new(width, height),
            labels: taken.labels.as_ref().map(|_| GrayImage::new(width, height)),
        };
        let film = |column: f64, row: f64| {
            let [fx, fy] = camera.focal.map(f64::from);
            let [cx, cy] = camera.centre.map(f64::from);
            [(column - cx) / fx, (row - cy) / fy]
        };
        let (w, h) = (width as f64, height as f64);
        let corners = [[0.0, 0.0], [w, 0.0], [0.0, h], [w, h]].map(|[x, y]| film(x, y));
        let reach = self.reach(corners.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max));
        for row in 0..height {
            for column in 0..width {
                let at = film(column as f64 + 0.5, row as f64 + 0.5);
                if at[0].hypot(at[1]) > reach {
                    continue;
                }
                let [x, y] = pixel(camera, self.distort(at));
                if !(x >= 0.0 && x < w && y >= 0.0 && y < h) {
                    continue;
                }
                let (index, nearest) = (row * width + column, y as usize * width + x as usize);
                result.mask.data[index] = taken.mask.data[nearest];
                if let (Some(to), Some(from)) = (&mut result.labels, &taken.labels) {
                    to.data[index] = from.data[nearest];
                }
                bilinear(image, x, y, result.image.pixel_mut(column, row));
            }
        }
        result
    }
}

/// Pixel coordinates of a place on the film, both from the top left.
fn pixel(camera: &Camera, [x, y]: [f64; 2]) -> [f64; 2] {
    let along = |axis: usize, value: f64| {
        f64::from(camera.centre[axis]) + f64::from(camera.focal[axis]) * value
    };
    [along(0, x), along(1, y)]
}

/// The picture between the pixel centres around `(x, y)`; its border goes on outside.
fn bilinear(image: &Picture, x: f64, y: f64, result: &mut [f32]) {
    let split = |value: f64, size: usize| {
        let value = (value - 0.5).clamp(0.0, (size - 1) as f64);
        let low = value as usize;
        (low, (low + 1).min(size - 1), (value - low as f64) as f32)
    };
    let (left, right, s) = split(x, image.width);
    let (top, bottom, t) = split(y, image.height);
    let rows = [top, bottom].map(|row| [image.pixel(left, row), image.pixel(right, row)]);
    for (channel, value) in result.iter_mut().enumerate() {
        let [upper, lower] = rows.map(|[a, b]| a[channel] + s * (b[channel] - a[channel]));
        *value = upper + t * (lower - upper);
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::testing;

    const LENS: Distortion = Distortion { k1: -0.25, k2: 0.08, p1: 0.004, p2: -0.003 };

    /// A camera with a picture whose red is the column and whose green is the row of every pixel's centre.
    fn ramp() -> (Camera, Layers) {
        let (width, height) = (64, 48);
        let mut camera = testing::camera("000", Vec3::Z, 64);
        (camera.width, camera.height) = (width, height);
        (camera.focal, camera.centre) = ([60.0, 58.0], [33.0, 23.0]);
        let mut image = Picture::new(width, height, 3);
        let mut ids = GrayImage::new(width, height);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            image.pixel_mut(x, y)[..2].copy_from_slice(&[x as f32 + 0.5, y as f32 + 0.5]);
            ids.data[y * width + x] = x as u8;
        }
        let mask = GrayImage { width, height, data: vec![255; width * height] };
        (camera, Layers { image, mask, labels: Some(ids) })
    }

    #[test]
    fn the_terms_are_those_of_opencv() {
        // SciPy 1.16.3: fsolve of OpenCV's formula for the second column, in double precision.
        let cases = [
            ([0.3, -0.2], [0.31200979, -0.20829886]),
            ([-0.45, 0.1], [-0.47325518, 0.10434321]),
            ([0.02, 0.5], [0.02217869, 0.53074998]),
        ];
        for (seen, pinhole) in cases {
            let [x, y] = LENS.distort(pinhole);
            assert!((x - seen[0]).hypot(y - seen[1]) < 2e-8, "{x} {y} for {seen:?}");
        }
    }

    #[test]
    fn a_pinhole_pixel_shows_what_the_lens_put_elsewhere() {
        let (camera, taken) = ramp();
        let view = LENS.undistort(&camera, &taken);
        // OpenCV's formula in NumPy, in pixels, for pixel centres of this camera.
        let cases = [
            ((0, 0), [3.50966, 2.74191]),
            ((63, 47), [60.56615, 45.30781]),
            ((10, 40), [11.55987, 39.69697]),
            ((33, 23), [33.49997, 23.50002]),
            ((60, 5), [58.43315, 6.85063]),
        ];
        for ((column, row), expected) in cases {
            let found = view.image.pixel(column, row);
            let off = (found[0] - expected[0]).hypot(found[1] - expected[1]);
            assert!(off < 1e-4, "{found:?} at {column}, {row} instead of {expected:?}");
            let index = row * 64 + column;
            assert_eq!(view.mask.data[index], 255);
            assert_eq!(view.labels.as_ref().unwrap().data[index], expected[0] as u8);
        }
    }

    #[test]
    fn what_the_lens_did_not_see_is_no_foreground() {
        // Pincushion: the corners of the pinhole's picture lie beyond the lens's.
        let lens = Distortion { k1: 0.3, k2: 0.0, p1: 0.0, p2: 0.0 };
        let (camera, taken) = ramp();
        let view = lens.undistort(&camera, &taken);
        assert_eq!(view.mask.data[0], 0);
        assert_eq!(view.image.pixel(0, 0), [0.0; 3]);
        assert_eq!(view.mask.data[24 * 64 + 33], 255);
        // A polynomial that folds back at a radius of 1 / sqrt(6): 24.5 columns from the axis.
        let folding = Distortion { k1: -2.0, ..lens };
        assert!((folding.reach(1.0) - 6f64.sqrt().recip()).abs() < 0.005);
        assert_eq!(folding.undistort(&camera, &taken).mask.data[24 * 64], 0);
        assert!((LENS.reach(0.7) - 0.7).abs() < 1e-9);
    }
}
