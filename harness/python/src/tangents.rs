//! Tangents as every tool of the trade makes them.

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use numpy::ndarray::Array3;
use numpy::{IntoPyArray, PyArray3, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::arrays::rows;

/// Tangents (F, 3, 4) of a mesh: xyz unit, and the sign of the bitangent; raises ValueError.
#[pyfunction]
pub(super) fn mikktspace<'py>(
    py: Python<'py>,
    vertices: PyReadonlyArray2<f32>,
    normals: PyReadonlyArray2<f32>,
    uv: PyReadonlyArray2<f32>,
    triangles: PyReadonlyArray2<i64>,
) -> PyResult<Bound<'py, PyArray3<f32>>> {
    let mut mesh = Mesh {
        vertices: rows("vertices", &vertices)?,
        normals: rows("normals", &normals)?,
        uv: rows("uv", &uv)?,
        triangles: rows("triangles", &triangles)?,
        tangents: Vec::new(),
    };
    let count = mesh.vertices.len();
    if mesh.normals.len() != count || mesh.uv.len() != count {
        return Err(PyValueError::new_err("normals, uv: expected one per vertex"));
    }
    let known = |index: &i64| usize::try_from(*index).is_ok_and(|index| index < count);
    if !mesh.triangles.iter().flatten().all(known) {
        return Err(PyValueError::new_err("triangles: an index names no vertex"));
    }
    mesh.tangents = vec![[[0.0, 0.0, 0.0, 1.0]; 3]; mesh.triangles.len()];
    py.detach(|| generate_tangents(&mut mesh))
        .map_err(|error| PyValueError::new_err(error.to_string()))?;
    let tangents = &mesh.tangents;
    let array = Array3::from_shape_fn((tangents.len(), 3, 4), |(face, corner, axis)| {
        tangents[face][corner][axis]
    });
    Ok(array.into_pyarray(py))
}

struct Mesh {
    vertices: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uv: Vec<[f32; 2]>,
    triangles: Vec<[i64; 3]>,
    tangents: Vec<[[f32; 4]; 3]>,
}

impl Mesh {
    fn corner(&self, face: usize, corner: usize) -> usize {
        self.triangles[face][corner] as usize
    }
}

impl Geometry for Mesh {
    fn num_faces(&self) -> usize {
        self.triangles.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.vertices[self.corner(face, corner)]
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.normals[self.corner(face, corner)]
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.uv[self.corner(face, corner)]
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        if let Some(space) = space {
            self.tangents[face][corner] = space.tangent_encoded();
        }
    }
}
