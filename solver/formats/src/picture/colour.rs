//! Linear RGB of other primaries as linear Rec.709.

use super::Picture;

/// CIE xy of red, green, blue and white.
pub(super) type Chromaticities = [[f32; 2]; 4];
type Matrix = [[f64; 3]; 3];

const REC709: Chromaticities = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]];
/// CIE XYZ as a file states it.
pub(super) const XYZ: Chromaticities = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0 / 3.0, 1.0 / 3.0]];
/// Writers round differently, D65 above all; the next colour space in use is .03 away.
const SAME: f32 = 2e-3;

const BRADFORD: Matrix =
    [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];

/// The matrix to linear Rec.709; None where the file states Rec.709. White goes to white by
/// Bradford's adaptation, except from XYZ, which are tristimulus values of no white of their own.
pub(super) fn to_rec709(from: &Chromaticities) -> Result<Option<Matrix>, String> {
    if same(from, &REC709) {
        return Ok(None);
    }
    let wrong = || {
        format!(
            "its primaries {from:?} (chromaticities or PRIMARIES) are not a colour space; drop or fix them"
        )
    };
    let back = rgb_to_xyz(&REC709).and_then(inverse).ok_or_else(wrong)?;
    let forward = rgb_to_xyz(from).ok_or_else(wrong)?;
    let adapted = if same(from, &XYZ) {
        forward
    } else {
        product(&adaptation(from[3], REC709[3]).ok_or_else(wrong)?, &forward)
    };
    let matrix = product(&back, &adapted);
    // A grey must stay one, or the numbers are no primaries at all.
    let sound = matrix.iter().flatten().all(|value| value.is_finite() && value.abs() < 100.0);
    if sound { Ok(Some(matrix)) } else { Err(wrong()) }
}

/// Converts the channels `rgb` of every pixel.
pub(super) fn convert(picture: &mut Picture, rgb: [usize; 3], matrix: &Matrix) {
    for pixel in picture.data.chunks_exact_mut(picture.channels) {
        let values = rgb.map(|channel| f64::from(pixel[channel]));
        for (channel, row) in rgb.into_iter().zip(matrix) {
            pixel[channel] = row.iter().zip(values).map(|(a, b)| a * b).sum::<f64>() as f32;
        }
    }
}

fn same(a: &Chromaticities, b: &Chromaticities) -> bool {
    a.iter().flatten().zip(b.iter().flatten()).all(|(a, b)| (a - b).abs() <= SAME)
}

/// XYZ of a chromaticity of luminance 1.
fn white([x, y]: [f32; 2]) -> Option<[f64; 3]> {
    let (x, y) = (f64::from(x), f64::from(y));
    (x > 0.0 && y > 0.0 && x + y < 1.0).then(|| [x / y, 1.0, (1.0 - x - y) / y])
}

/// Columns are the primaries, scaled so that 1, 1, 1 is the white of luminance 1.
fn rgb_to_xyz(space: &Chromaticities) -> Option<Matrix> {
    let mut columns = [[0.0; 3]; 3];
    for (channel, primary) in space[..3].iter().enumerate() {
        let [x, y] = primary.map(f64::from);
        for (row, value) in columns.iter_mut().zip([x, y, 1.0 - x - y]) {
            row[channel] = value;
        }
    }
    let scale = applied(&inverse(columns)?, white(space[3])?);
    Some(columns.map(|row| [row[0] * scale[0], row[1] * scale[1], row[2] * scale[2]]))
}

/// XYZ under one white to XYZ that look alike under another.
fn adaptation(from: [f32; 2], to: [f32; 2]) -> Option<Matrix> {
    let (from, to) = (applied(&BRADFORD, white(from)?), applied(&BRADFORD, white(to)?));
    let mut cones = BRADFORD;
    for (row, (from, to)) in cones.iter_mut().zip(from.into_iter().zip(to)) {
        *row = row.map(|value| value * to / from);
    }
    Some(product(&inverse(BRADFORD)?, &cones))
}

fn applied(m: &Matrix, v: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|row| m[row][0] * v[0] + m[row][1] * v[1] + m[row][2] * v[2])
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let column = |k: usize| applied(a, [b[0][k], b[1][k], b[2][k]]);
    let [x, y, z] = [column(0), column(1), column(2)];
    [0, 1, 2].map(|row| [x[row], y[row], z[row]])
}

fn inverse(m: Matrix) -> Option<Matrix> {
    let matrix = glam::DMat3::from_cols_array_2d(&m).transpose();
    let determinant = matrix.determinant();
    (determinant.is_finite() && determinant.abs() > 1e-9)
        .then(|| matrix.inverse().transpose().to_cols_array_2d())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Matrices of colour-science (`matrix_RGB_to_RGB`, Bradford).
    #[test]
    fn acescg_and_rec2020_go_where_the_published_matrices_send_them() {
        let acescg = [[0.713, 0.293], [0.165, 0.830], [0.128, 0.044], [0.32168, 0.33767]];
        let published = [
            [1.70505, -0.62179, -0.08326],
            [-0.13026, 1.14080, -0.01055],
            [-0.02400, -0.12897, 1.15297],
        ];
        let rec2020 = [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046], [0.3127, 0.3290]];
        let wide =
            [[1.6605, -0.5876, -0.0728], [-0.1246, 1.1329, -0.0083], [-0.0182, -0.1006, 1.1187]];
        for (space, expected) in [(acescg, published), (rec2020, wide)] {
            let matrix = to_rec709(&space).unwrap().unwrap();
            for (a, b) in matrix.iter().flatten().zip(expected.iter().flatten()) {
                assert!((a - b).abs() < 3e-4, "{matrix:?}");
            }
        }
    }

    #[test]
    fn xyz_of_daylight_is_white_and_rec709_is_left_alone() {
        let matrix = to_rec709(&XYZ).unwrap().unwrap();
        for value in applied(&matrix, [0.95046, 1.0, 1.08906]) {
            assert!((value - 1.0).abs() < 1e-3, "{value}");
        }
        let mut rounded = REC709;
        rounded[3] = [0.313, 0.329];
        assert!(to_rec709(&rounded).unwrap().is_none());
        assert!(to_rec709(&[[0.0; 2]; 4]).is_err());
        assert!(to_rec709(&[[f32::NAN; 2]; 4]).is_err());
    }
}
