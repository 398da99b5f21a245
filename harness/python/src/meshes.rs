//! Meshes of your own heads: the solver's reader of OBJ files, which way surfaces face, and
//! what a camera sees of them.

use capture::gbuffer::rasterise;
use capture::uv_layout::{self, Layout, LayoutFault, Parts};
use capture::{Camera, Mesh, outward};
use glam::{DVec2, DVec3, Mat4, Vec2, Vec3};
use numpy::ndarray::Array2;
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use super::threads::detached;

/// The objects of an OBJ file; raises ValueError with the line.
#[pyfunction]
pub(super) fn read_obj<'py>(py: Python<'py>, data: &[u8]) -> PyResult<Bound<'py, PyList>> {
    let objects = detached(py, || formats::obj::read(data))?;
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
        let mut parts = Parts::default();
        parts.add(&object);
        dict.set_item("parts", parts.names)?;
        let part_of: Vec<i64> = parts.of.into_iter().map(i64::from).collect();
        dict.set_item("part_of", part_of.into_pyarray(py))?;
        list.append(dict)?;
    }
    Ok(list)
}

/// Return the fault of a UV layout and a warning, each a text or None, whether the fault is that several of
/// ``parts``, numbered by ``part_of`` (F,), lie over each other on one page, and the number of islands that hold most
/// of the area (0 with a fault).
#[pyfunction]
#[allow(clippy::type_complexity)]
pub(super) fn examine_layout(
    py: Python<'_>,
    vertices: PyReadonlyArray2<f64>,
    uv: PyReadonlyArray2<f64>,
    triangles: PyReadonlyArray2<i64>,
    part_of: PyReadonlyArray1<i64>,
    parts: Vec<String>,
) -> PyResult<(Option<String>, Option<String>, bool, usize)> {
    let row = |array: &PyReadonlyArray2<f64>, i: usize, k: usize| array.as_array()[[i, k]];
    let count = vertices.shape()[0];
    if vertices.shape()[1] != 3 || uv.shape() != [count, 2] {
        return Err(PyValueError::new_err("expected vertices (n, 3) and uv (n, 2)"));
    }
    let positions: Vec<DVec3> = (0..count)
        .map(|i| DVec3::new(row(&vertices, i, 0), row(&vertices, i, 1), row(&vertices, i, 2)))
        .collect();
    let uvs: Vec<DVec2> = (0..count).map(|i| DVec2::new(row(&uv, i, 0), row(&uv, i, 1))).collect();
    let triangles = corners(&triangles, count)?;
    let known = |part: &i64| u32::try_from(*part).ok().filter(|p| (*p as usize) < parts.len());
    let of: Option<Vec<u32>> = part_of.as_array().iter().map(known).collect();
    let of = of.filter(|of| of.len() == triangles.len());
    let of = of.ok_or_else(|| PyValueError::new_err("part_of: expected a part per triangle"))?;
    let parts = Parts { names: parts, of };
    detached(py, || {
        let (positions, uvs, triangles) = (&positions, &uvs, &triangles);
        match uv_layout::examine(&Layout { positions, uvs, triangles, parts: &parts }) {
            Ok(islands) => (None, uv_layout::islands_warning(islands), false, islands),
            Err(fault) => {
                let is_of_pages = matches!(fault, LayoutFault::Pages { .. });
                (Some(fault.to_string()), None, is_of_pages, 0)
            }
        }
    })
}

/// Triangles and normals to turn so that all face away from the origin, and triangles on one-sided
/// surfaces.
#[pyfunction]
#[pyo3(signature = (vertices, triangles, normals=None))]
#[allow(clippy::type_complexity)]
pub(super) fn outward_turns<'py>(
    py: Python<'py>,
    vertices: PyReadonlyArray2<f64>,
    triangles: PyReadonlyArray2<i64>,
    normals: Option<PyReadonlyArray2<f64>>,
) -> PyResult<(Bound<'py, PyArray1<bool>>, Bound<'py, PyArray1<bool>>, usize)> {
    let positions = vectors("vertices", &vertices)?;
    let normals = normals.as_ref().map(|normals| vectors("normals", normals)).transpose()?;
    if normals.as_ref().is_some_and(|normals| normals.len() != positions.len()) {
        return Err(PyValueError::new_err("normals: expected one per vertex"));
    }
    let faces = corners(&triangles, positions.len())?;
    let found = detached(py, || outward::outward(&positions, normals.as_deref(), &faces))?;
    let flipped = found.triangles.into_pyarray(py);
    Ok((flipped, found.normals.into_pyarray(py), found.one_sided))
}

/// Depth at every pixel's centre (height, width) for a pinhole of ``size`` (width, height);
/// infinite beside the mesh.
#[pyfunction]
pub(super) fn depth_of<'py>(
    py: Python<'py>,
    vertices: PyReadonlyArray2<f64>,
    triangles: PyReadonlyArray2<i64>,
    size: (usize, usize),
    focal: [f32; 2],
    centre: [f32; 2],
    camera_to_world: [[f32; 4]; 4],
) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let positions = vectors("vertices", &vertices)?;
    let triangles = corners(&triangles, positions.len())?;
    // Only positions decide what is seen.
    let (normals, uvs) = (vec![Vec3::Z; positions.len()], vec![Vec2::ZERO; positions.len()]);
    let mesh = Mesh { positions, normals, uvs, triangles };
    let (width, height) = size;
    let camera_to_world = Mat4::from_cols_array_2d(&camera_to_world).transpose();
    let camera = Camera { name: String::new(), width, height, focal, centre, camera_to_world };
    let raster = detached(py, || rasterise(&mesh, &camera))?;
    let depth = |(row, column): (usize, usize)| {
        raster.hits[row * width + column].map_or(f32::INFINITY, |hit| hit.depth)
    };
    Ok(Array2::from_shape_fn((height, width), depth).into_pyarray(py))
}

fn vectors(name: &str, array: &PyReadonlyArray2<f64>) -> PyResult<Vec<Vec3>> {
    let view = array.as_array();
    if view.ncols() != 3 {
        let shape = array.shape();
        return Err(PyValueError::new_err(format!("{name}: expected (n, 3), got {shape:?}")));
    }
    let vector = |row: numpy::ndarray::ArrayView1<f64>| {
        Vec3::new(row[0] as f32, row[1] as f32, row[2] as f32)
    };
    Ok(view.rows().into_iter().map(vector).collect())
}

/// Triangles of a mesh with `count` vertices.
fn corners(triangles: &PyReadonlyArray2<i64>, count: usize) -> PyResult<Vec<[u32; 3]>> {
    let corner = |index: &i64| {
        let index = u32::try_from(*index).ok().filter(|index| (*index as usize) < count);
        index.ok_or_else(|| PyValueError::new_err("triangles: an index names no vertex"))
    };
    let view = triangles.as_array();
    if view.ncols() != 3 {
        return Err(PyValueError::new_err("triangles: expected (n, 3)"));
    }
    let faces = view.rows().into_iter();
    faces.map(|row| Ok([corner(&row[0])?, corner(&row[1])?, corner(&row[2])?])).collect()
}

fn rows<'py, const N: usize>(py: Python<'py>, rows: &[[f64; N]]) -> Bound<'py, PyArray2<f64>> {
    Array2::from_shape_fn((rows.len(), N), |(row, column)| rows[row][column]).into_pyarray(py)
}
