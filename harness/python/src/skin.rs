//! The solver's model of skin, for those who hold another against it.

use glam::Vec3;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use solver::transport::skin::reflected;

use super::arrays::rows;

/// The solver's specular BRDF of skin times the cosine (N,), 1/sr; unit vectors (N, 3); raises
/// ValueError.
#[pyfunction]
pub(super) fn skin_reflected<'py>(
    py: Python<'py>,
    normals: PyReadonlyArray2<f32>,
    views: PyReadonlyArray2<f32>,
    lights: PyReadonlyArray2<f32>,
) -> PyResult<Bound<'py, PyArray1<f32>>> {
    let normals = rows::<f32, 3>("normals", &normals)?;
    let (views, lights) = (rows::<f32, 3>("views", &views)?, rows::<f32, 3>("lights", &lights)?);
    if views.len() != normals.len() || lights.len() != normals.len() {
        return Err(PyValueError::new_err("views, lights: expected one per normal"));
    }
    let skin = solver::config::UnshadeConfig::default().skin;
    let values = normals.iter().zip(&views).zip(&lights).map(|((normal, view), light)| {
        let [normal, view, light] = [normal, view, light].map(|v| Vec3::from_array(*v));
        reflected(&skin, normal, view, light)
    });
    Ok(values.collect::<Vec<f32>>().into_pyarray(py))
}
