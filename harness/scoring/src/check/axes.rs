//! The frames in which normals are written by mistake: axes swapped or negated, a camera's, or
//! any other turn against the mesh.

use glam::Mat3;

/// A frame that explains normals: what takes them back to the mesh's.
pub(super) struct Frame {
    /// Id of the fault.
    pub id: &'static str,
    /// The fault, in words.
    pub wrong: String,
    /// The fix.
    pub fix: String,
    /// Mean cosine between the mesh's normals and those taken back.
    pub cosine: f64,
}

/// Mean cosine by which another frame must fit better than a simpler one.
const GAIN: f64 = 0.02;

/// The frame that explains best, the simpler one first. `moment` is the mean of mesh normal times
/// normal (transposed), so that the mean cosine of a turn is the sum of its products with it.
pub(super) fn best_frame(moment: Mat3, cameras: &[(String, Mat3)]) -> Option<Frame> {
    let swapped = signed_permutations()
        .into_iter()
        .map(|(turn, words)| (mean_cosine(moment, turn), words))
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    let mut best = permutation_frame(swapped.0, swapped.1);
    // y and z of a camera that looks along +z with y down, as in OpenCV.
    let opencv = Mat3::from_diagonal(glam::Vec3::new(1.0, -1.0, -1.0));
    for (name, world_to_camera) in cameras {
        for (axes, convention) in [(Mat3::IDENTITY, "OpenGL"), (opencv, "OpenCV")] {
            let back = (axes * *world_to_camera).transpose();
            let cosine = mean_cosine(moment, back);
            let gain = if best.id == "camera-space" { 0.0 } else { GAIN };
            if cosine > best.cosine + gain {
                best = Frame {
                    id: "camera-space",
                    wrong: format!("is in the space of camera {name} ({convention} axes)"),
                    fix: format!(
                        "turn it to object space by the camera_to_world of {name} before writing"
                    ),
                    cosine,
                };
            }
        }
    }
    if let Some(turn) = nearest_rotation(moment) {
        let cosine = mean_cosine(moment, turn);
        if cosine > best.cosine + GAIN {
            let (axis, angle) = glam::Quat::from_mat3(&turn).to_axis_angle();
            let (x, y, z, degrees) = (axis.x, axis.y, axis.z, angle.to_degrees());
            best = Frame {
                id: "turned-normals",
                wrong: format!(
                    "is turned against the mesh by {degrees:.0} degrees about ({x:.2}, {y:.2}, {z:.2})"
                ),
                fix: "write it in the space of the capture's mesh.obj".to_owned(),
                cosine,
            };
        }
    }
    Some(best)
}

/// Mean cosine after a turn.
pub(super) fn mean_cosine(moment: Mat3, turn: Mat3) -> f64 {
    let products = moment.to_cols_array().into_iter().zip(turn.to_cols_array());
    products.map(|(a, b)| f64::from(a) * f64::from(b)).sum()
}

/// For each world axis, the axis of the map that holds it, and its sign.
type Axes = [(usize, f32); 3];

fn signed_permutations() -> Vec<(Mat3, Axes)> {
    let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let mut all = Vec::new();
    for order in orders {
        for signs in 0..8 {
            let axes: Axes = std::array::from_fn(|row| {
                (order[row], if signs >> row & 1 == 1 { -1.0 } else { 1.0 })
            });
            let mut columns = [[0.0; 3]; 3];
            for (row, (from, sign)) in axes.iter().enumerate() {
                columns[*from][row] = *sign;
            }
            all.push((Mat3::from_cols_array_2d(&columns), axes));
        }
    }
    all
}

fn permutation_frame(cosine: f64, axes: Axes) -> Frame {
    let letter = |axis: usize| ["x", "y", "z"][axis];
    let named = |axes: Axes| {
        let name = |(axis, sign): (usize, f32)| {
            format!("{}{}", if sign < 0.0 { "-" } else { "" }, letter(axis))
        };
        axes.map(name).join(", ")
    };
    let in_place = axes.iter().enumerate().all(|(row, (from, _))| row == *from);
    let negated: Vec<&str> =
        axes.iter().filter(|(_, sign)| *sign < 0.0).map(|(axis, _)| letter(*axis)).collect();
    let (id, wrong) = match (in_place, negated.as_slice()) {
        (true, []) => ("upright", "is as it should be".to_owned()),
        (true, ["x", "y", "z"]) => ("negated", "is negated: it points into the face".to_owned()),
        (true, ["y"]) => ("y-flipped", "has its y axis flipped".to_owned()),
        (true, [axis]) if *axis == "x" => ("x-flipped", "has its x axis flipped".to_owned()),
        (true, [_]) => ("z-flipped", "has its z axis flipped".to_owned()),
        (true, axes) => ("axes", format!("has its axes {} flipped", axes.join(" and "))),
        (false, _) => ("axes", format!("has its axes swapped: x, y, z are its {}", named(axes))),
    };
    let fix = format!("write ({}) of what it holds now as R, G, B", named(axes));
    Frame { id, wrong, fix, cosine }
}

/// The rotation nearest to a matrix (its polar factor by Newton's iteration); none of a matrix
/// that mirrors or is nearly singular, of which there is no sure one.
fn nearest_rotation(matrix: Mat3) -> Option<Mat3> {
    const ITERATIONS: usize = 30;
    if matrix.determinant() < 1e-4 {
        return None;
    }
    let mut turn = matrix;
    for _ in 0..ITERATIONS {
        turn = (turn + turn.inverse().transpose()) * 0.5;
    }
    turn.is_finite().then_some(turn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Wrong conventions of normals, the fault's id, and words that name it.
    type Case<'a> = (&'a dyn Fn(Vec3) -> Vec3, &'a str, &'a str);

    /// Normals all around the front, more of them upwards than downwards.
    fn moment(written: impl Fn(Vec3) -> Vec3) -> Mat3 {
        let mut sum = Mat3::ZERO;
        for i in 0..400 {
            let (u, v) = ((i % 20) as f32 / 10.0 - 0.95, (i / 20) as f32 / 10.0 - 0.8);
            let mesh = Vec3::new(u * 0.6, v * 0.9, 1.0).normalize();
            let normal = written(mesh);
            sum += Mat3::from_cols(mesh * normal.x, mesh * normal.y, mesh * normal.z);
        }
        sum * (1.0 / 400.0)
    }

    #[test]
    fn each_frame_is_named() {
        let camera = Mat3::from_rotation_y(0.6) * Mat3::from_rotation_x(0.3);
        let opencv = Mat3::from_diagonal(Vec3::new(1.0, -1.0, -1.0));
        let turn = Mat3::from_axis_angle(Vec3::new(0.6, 0.8, 0.0), 1.0);
        let cameras = [("007".to_owned(), camera)];
        let cases: [Case; 8] = [
            (&|n| n, "upright", ""),
            (&|n| -n, "negated", "into the face"),
            (&|n| Vec3::new(n.x, -n.y, n.z), "y-flipped", "y axis"),
            (&|n| Vec3::new(n.x, -n.z, n.y), "axes", "x, y, z are its x, z, -y"),
            (&|n| Vec3::new(n.z, n.y, n.x), "axes", "x, y, z are its z, y, x"),
            (&|n| camera * n, "camera-space", "camera 007 (OpenGL"),
            (&|n| opencv * (camera * n), "camera-space", "camera 007 (OpenCV"),
            (&|n| turn * n, "turned-normals", "57 degrees"),
        ];
        for (written, id, words) in cases {
            let frame = best_frame(moment(written), &cameras).unwrap();
            assert_eq!(frame.id, id, "{}", frame.wrong);
            assert!(frame.wrong.contains(words), "{}", frame.wrong);
            assert!(frame.cosine > 0.999);
        }
    }
}
