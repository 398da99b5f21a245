//! The size of a texel on a face.

use std::fs;
use std::path::Path;

use formats::obj;

use crate::error::ReportError;

/// Mean side of a texel of a texture with `side` texels, millimetres: the root of the ratio of the mesh's area to
/// the area of its chart. `mesh` is an OBJ in metres.
pub(super) fn texel_millimetres(mesh: &Path, side: usize) -> Result<f64, ReportError> {
    let bytes = fs::read(mesh).map_err(|error| ReportError::read(mesh, error))?;
    let broken = |reason: String| ReportError::Json { path: mesh.to_path_buf(), reason };
    let objects = obj::read(&bytes).map_err(|error| broken(error.to_string()))?;
    let (mut surface, mut chart) = (0.0, 0.0);
    for object in &objects {
        let Some(uvs) = &object.uvs else { continue };
        for corners in &object.triangles {
            let at = corners.map(|corner| object.positions[corner as usize]);
            surface += area(at);
            chart += area(corners.map(|corner| {
                let [u, v] = uvs[corner as usize];
                [u, v, 0.0]
            }));
        }
    }
    if !(surface > 0.0 && chart > 0.0) {
        return Err(broken("the mesh or its chart has no area".to_owned()));
    }
    Ok(1000.0 * f64::sqrt(surface / chart) / side as f64)
}

fn area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let side = |to: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| to[i] - a[i]) };
    let (u, v) = (side(b), side(c));
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    0.5 * cross.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_of_a_decimetre_over_half_the_chart_s_width() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.obj");
        let text = "v 0 0 0\nv .1 0 0\nv .1 .1 0\nv 0 .1 0\nvt 0 0\nvt .5 0\nvt .5 .5\nvt 0 .5\n\
                    f 1/1 2/2 3/3 4/4\n";
        fs::write(&path, text).unwrap();
        // 0.1 m are half of 100 texels.
        assert!((texel_millimetres(&path, 100).unwrap() - 2.0).abs() < 1e-9);
    }
}
