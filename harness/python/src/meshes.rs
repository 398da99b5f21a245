//! Meshes of heads of one's own: the solver's reader of OBJ files, and which way surfaces face.

use capture::outward;
use glam::Vec3;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// The objects of an OBJ file, each a dict of `name`, `vertices` (V,3) float64, `triangles` (F,3)
/// int64, `uv` (V,2) and `normals` (V,3) float64 or None, and `line_without_uv`, a line number or
/// None. Raises ValueError for what cannot be read, with the line.
#[pyfunction]
pub(super) fn read_obj<'py>(py: Python<'py>, data: &[u8]) -> PyResult<Bound<'py, PyList>> {
    let objects = py.detach(|| formats::obj::read(data));
    let objects = objects.map_err(|error| PyValueError::new_err(error.to_string()))?;
    let list = PyList::empty(py);
    for object in objects {
        let dict = PyDict::new(py);
        dict.set_item("name", &object.name)?;
        dict.set_item("vertices", rows(py, &object.positions))?;
        let triangles = Array2::from_shape_fn((object.triangles.len(), 3), |(row, column)| {
            i64::from(object.triangles[row][column])
        });
        dict.set_item("triangles", triangles.into_pyarray(py))?;
        dict.set_item("uv", object.uvs.as_deref().map(|uvs| rows(py, uvs)))?;
        dict.set_item("normals", object.normals.as_deref().map(|normals| rows(py, normals)))?;
        dict.set_item("line_without_uv", object.line_without_uv)?;
        list.append(dict)?;
    }
    Ok(list)
}

/// What must be turned for all surfaces to face outwards, away from the origin: triangles (F,)
/// bool, normals (V,) bool (empty without normals), and the number of triangles on surfaces with
/// one side only.
#[pyfunction]
#[pyo3(signature = (vertices, triangles, normals=None))]
#[allow(clippy::type_complexity)]
pub(super) fn outward_turns<'py>(
    py: Python<'py>,
    vertices: PyReadonlyArray2<f64>,
    triangles: PyReadonlyArray2<i64>,
    normals: Option<PyReadonlyArray2<f64>>,
) -> PyResult<(Bound<'py, PyArray1<bool>>, Bound<'py, PyArray1<bool>>, usize)> {
    let vectors = |name: &str, array: &PyReadonlyArray2<f64>| {
        let view = array.as_array();
        if view.ncols() != 3 {
            let shape = array.shape();
            return Err(PyValueError::new_err(format!("{name}: expected (n, 3), got {shape:?}")));
        }
        let vector = |row: numpy::ndarray::ArrayView1<f64>| {
            Vec3::new(row[0] as f32, row[1] as f32, row[2] as f32)
        };
        Ok(view.rows().into_iter().map(vector).collect::<Vec<_>>())
    };
    let positions = vectors("vertices", &vertices)?;
    let normals = normals.as_ref().map(|normals| vectors("normals", normals)).transpose()?;
    if normals.as_ref().is_some_and(|normals| normals.len() != positions.len()) {
        return Err(PyValueError::new_err("normals: expected one per vertex"));
    }
    let corner = |index: &i64| {
        let index = u32::try_from(*index).ok().filter(|index| (*index as usize) < positions.len());
        index.ok_or_else(|| PyValueError::new_err("triangles: an index names no vertex"))
    };
    let view = triangles.as_array();
    if view.ncols() != 3 {
        return Err(PyValueError::new_err("triangles: expected (n, 3)"));
    }
    let faces = view.rows().into_iter().map(|row| -> PyResult<[u32; 3]> {
        Ok([corner(&row[0])?, corner(&row[1])?, corner(&row[2])?])
    });
    let faces = faces.collect::<PyResult<Vec<_>>>()?;
    let found = py.detach(|| outward::outward(&positions, normals.as_deref(), &faces));
    let turned = found.triangles.into_pyarray(py);
    Ok((turned, found.normals.into_pyarray(py), found.one_sided))
}

fn rows<'py, const N: usize>(py: Python<'py>, rows: &[[f64; N]]) -> Bound<'py, PyArray2<f64>> {
    Array2::from_shape_fn((rows.len(), N), |(row, column)| rows[row][column]).into_pyarray(py)
}
