//! Single changes after which a mesh may fit its masks: mistakes that are often made.

use glam::{Mat3, Mat4, Vec3};

use super::silhouette::{Comparison, compare, median};
use crate::{Camera, Mesh, View};

/// Views at which a change is tried.
const MAX_VIEWS: usize = 5;
/// Triangles painted for one change.
const MAX_TRIANGLES: usize = 400_000;
/// Rounds in which a factor of the focal lengths is fitted.
const ROUNDS: usize = 6;
/// Widths of sensors, millimetres: full frame, APS-C (two), Micro Four Thirds.
const SENSORS: [f64; 4] = [36.0, 23.6, 22.3, 17.3];

/// A change, and how well the mesh fits with it.
pub(super) struct Trial {
    /// The change to make, in words.
    pub fix: String,
    /// Median intersection over union of silhouettes and masks.
    pub union: f64,
}

/// The change that fits best; the first one of equals.
pub(super) fn best(mesh: &Mesh, views: &[&View], applied: Option<Mat4>) -> Option<Trial> {
    let max_views = (MAX_TRIANGLES / mesh.triangles.len().max(1)).clamp(2, MAX_VIEWS);
    let views = spread(views, max_views);
    let mut trials = vec![inverted(mesh, &views)];
    trials.extend(focal(mesh, &views));
    trials.extend(moved(applied).into_iter().map(|(fix, change)| {
        let union = union(mesh, &views, |camera| change(camera));
        Trial { fix, union }
    }));
    let better = |best: Trial, next: Trial| if next.union > best.union { next } else { best };
    trials.into_iter().reduce(better)
}

fn union(mesh: &Mesh, views: &[&View], change: impl Fn(&Camera) -> Camera) -> f64 {
    let compared = views.iter().map(|view| compare(mesh, &change(&view.camera), &view.mask));
    median(compared.map(fit).collect())
}

/// Intersection over union; a mask of the whole picture fits nothing.
fn fit(found: Option<Comparison>) -> f64 {
    found.filter(|found| !found.unmasked).map_or(0.0, |found| found.union())
}

fn inverted(mesh: &Mesh, views: &[&View]) -> Trial {
    let compared = views.iter().map(|view| {
        let mut mask = view.mask.clone();
        mask.data.iter_mut().for_each(|value| *value = 255 - *value);
        fit(compare(mesh, &view.camera, &mask))
    });
    let fix = "the masks are inverted: write 255 where the mesh is seen".to_owned();
    Trial { fix, union: median(compared.collect()) }
}

/// Focal lengths times what makes the silhouettes as large as the masks.
fn focal(mesh: &Mesh, views: &[&View]) -> Option<Trial> {
    let width = views.first().map_or(1.0, |view| view.camera.width as f64);
    let fitted = |start: f64| {
        let mut factor = start;
        for _ in 0..ROUNDS {
            factor = (factor * growth(mesh, views, factor)?).clamp(1e-6, 1e6);
        }
        Some((union(mesh, views, |camera| times(camera, factor)), factor))
    };
    let starts = [1.0, width / SENSORS[0], width];
    let (union, factor) =
        starts.into_iter().filter_map(fitted).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let near = |value: f64| (factor / value - 1.0).abs() < 0.03;
    let unit = match SENSORS.iter().find(|sensor| near(width / **sensor)) {
        _ if near(width) => ": it is given as a share of the width".to_owned(),
        Some(sensor) => format!(": it is given in mm of a sensor {sensor} mm wide"),
        None => String::new(),
    };
    let fix = format!("multiply fl_x and fl_y by {factor:.3} (they count in pixels){unit}");
    Some(Trial { fix, union })
}

/// The ratio of the masks to the silhouettes with focal lengths times `factor`, along
/// an edge; `None` where the mesh is seen in no view.
fn growth(mesh: &Mesh, views: &[&View], factor: f64) -> Option<f64> {
    let sizes = views.iter().filter_map(|view| {
        let found = compare(mesh, &times(&view.camera, factor), &view.mask)?;
        (found.mesh > 0).then(|| (found.mask as f64 / found.mesh as f64).sqrt())
    });
    let sizes: Vec<f64> = sizes.collect();
    (!sizes.is_empty()).then(|| median(sizes))
}

fn times(camera: &Camera, factor: f64) -> Camera {
    let focal = camera.focal.map(|value| (f64::from(value) * factor) as f32);
    Camera { focal, ..camera.clone() }
}

type Change = Box<dyn Fn(&Camera) -> Camera>;

/// Changes of the cameras alone.
fn moved(applied: Option<Mat4>) -> Vec<(String, Change)> {
    let placed =
        |camera: &Camera, camera_to_world: Mat4| Camera { camera_to_world, ..camera.clone() };
    let mut changes: Vec<(String, Change)> = vec![(
        "set cx and cy to the picture's middle, w / 2 and h / 2".to_owned(),
        Box::new(|camera| {
            let centre = [camera.width as f32 / 2.0, camera.height as f32 / 2.0];
            Camera { centre, ..camera.clone() }
        }),
    )];
    if let Some(back) = applied.map(|applied| applied.inverse()).filter(Mat4::is_finite) {
        changes.push((
            "applied_transform turned the cameras but not the mesh: multiply the mesh's vertices \
             by it, or every transform_matrix from the left by its inverse"
                .to_owned(),
            Box::new(move |camera| placed(camera, back * camera.camera_to_world)),
        ));
    }
    let opencv = Mat4::from_scale(Vec3::new(1.0, -1.0, -1.0));
    changes.push((
        "transform_matrix has OpenCV's camera axes (y down, looking along z): negate its second \
         and third columns"
            .to_owned(),
        Box::new(move |camera| placed(camera, camera.camera_to_world * opencv)),
    ));
    let pytorch3d = Mat4::from_scale(Vec3::new(-1.0, 1.0, -1.0));
    changes.push((
        "transform_matrix has PyTorch3D's camera axes (x left, looking along z): negate its first \
         and third columns"
            .to_owned(),
        Box::new(move |camera| placed(camera, camera.camera_to_world * pytorch3d)),
    ));
    changes.push((
        "transform_matrix is world to camera: write its inverse".to_owned(),
        Box::new(move |camera| placed(camera, camera.camera_to_world.inverse())),
    ));
    changes.push((
        "transform_matrix is world to camera with OpenCV's axes (as COLMAP has it): write its \
         inverse, second and third columns negated"
            .to_owned(),
        Box::new(move |camera| placed(camera, camera.camera_to_world.inverse() * opencv)),
    ));
    for (unit, metres) in [("mm", 0.001_f32), ("cm", 0.01), ("inches", 0.0254), ("dm", 0.1)] {
        for (what, by) in [("mesh is", metres.recip()), ("cameras are", metres)] {
            changes.push((
                format!("the {what} in {unit} and the other in m: write both in metres"),
                Box::new(move |camera| {
                    // Scaling the mesh is scaling the cameras' distances the other way.
                    let mut matrix = camera.camera_to_world;
                    matrix.w_axis = (matrix.w_axis.truncate() * by).extend(1.0);
                    placed(camera, matrix)
                }),
            ));
        }
    }
    for (name, turn) in turns() {
        changes.push((
            format!(
                "the mesh has other axes than the cameras: write its vertices (x, y, z) as {name}"
            ),
            Box::new(move |camera| placed(camera, turn * camera.camera_to_world)),
        ));
    }
    changes
}

/// The 23 quarter turns that are one: what becomes of a vertex, and the turn of the cameras that
/// does the same.
fn turns() -> Vec<(String, Mat4)> {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    let mut turns = Vec::new();
    for order in orders {
        for signs in 0..8 {
            let sign = |row: usize| if signs >> row & 1 == 1 { -1.0 } else { 1.0 };
            let rows = Mat3::from_cols(
                axes[order[0]] * sign(0),
                axes[order[1]] * sign(1),
                axes[order[2]] * sign(2),
            );
            let turn = rows.transpose();
            if turn.determinant() < 0.0 || turn == Mat3::IDENTITY {
                continue;
            }
            let part = |row: usize| {
                let minus = if sign(row) < 0.0 { "-" } else { "" };
                format!("{minus}{}", ["x", "y", "z"][order[row]])
            };
            let name = format!("({}, {}, {})", part(0), part(1), part(2));
            turns.push((name, Mat4::from_mat3(turn.transpose())));
        }
    }
    turns
}

/// At most `max_count` of the items, evenly spread.
pub(super) fn spread<T: Copy>(items: &[T], max_count: usize) -> Vec<T> {
    let count = items.len().min(max_count);
    (0..count).map(|index| items[index * items.len() / count]).collect()
}
