//! `unshade.Maps`.

use std::path::PathBuf;

use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use solver::picture::{GrayImage, Picture};

use super::arrays;
use super::errors::{named_error, raise};

/// Reflectance maps; what a solver does not recover is None.
#[pyclass(module = "unshade")]
#[derive(Default)]
pub(super) struct Maps {
    pub(super) inner: solver::Maps,
    pub(super) interrupted: Option<String>,
}

type Given<'py> = Option<PyReadonlyArrayDyn<'py, f32>>;
type Taken<'py> = PyResult<Option<Bound<'py, PyArrayDyn<f32>>>>;

/// A map from an array, with the channels that it must have.
fn map_from(name: &str, channels: usize, array: Given) -> PyResult<Option<Picture>> {
    let Some(array) = array else { return Ok(None) };
    let picture = arrays::picture_from_array(name, &array)?;
    if picture.channels != channels || picture.width != picture.height {
        let (w, h, c) = (picture.width, picture.height, picture.channels);
        let reason =
            format!("{name}: is {h} x {w} x {c}; it must be square with {channels} channels");
        return Err(named_error("MapsError", &reason));
    }
    Ok(Some(picture))
}

fn array_of<'py>(py: Python<'py>, map: &Option<Picture>) -> Taken<'py> {
    map.as_ref().map(|map| arrays::picture_to_array(py, map)).transpose()
}

#[pymethods]
impl Maps {
    #[new]
    #[pyo3(signature = (*, diffuse_albedo=None, specular_albedo=None, diffuse_normal=None,
                        specular_normal=None, coverage=None))]
    fn new(
        diffuse_albedo: Given,
        specular_albedo: Given,
        diffuse_normal: Given,
        specular_normal: Given,
        coverage: Option<PyReadonlyArrayDyn<u8>>,
    ) -> PyResult<Self> {
        let mut maps = Self::default();
        maps.set_diffuse_albedo(diffuse_albedo)?;
        maps.set_specular_albedo(specular_albedo)?;
        maps.set_diffuse_normal(diffuse_normal)?;
        maps.set_specular_normal(specular_normal)?;
        maps.set_coverage(coverage)?;
        Ok(maps)
    }

    /// Reads whatever maps the folder has.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let inner = py.detach(|| solver::Maps::read(&path)).map_err(raise)?;
        Ok(Self { inner, interrupted: solver::solution::interrupted(&path) })
    }

    /// Writes the folder, completely or not at all.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.inner.write(&path)).map_err(raise)
    }

    /// Where the solve was stopped; None for maps of a solve that came to its end.
    #[getter]
    fn interrupted(&self) -> Option<&str> {
        self.interrupted.as_deref()
    }

    /// (size, size, 3) linear Rec.709 reflectance.
    #[getter]
    fn diffuse_albedo<'py>(&self, py: Python<'py>) -> Taken<'py> {
        array_of(py, &self.inner.diffuse_albedo)
    }

    #[setter]
    fn set_diffuse_albedo(&mut self, array: Given) -> PyResult<()> {
        self.inner.diffuse_albedo = map_from("diffuse_albedo", 3, array)?;
        Ok(())
    }

    /// (size, size) reflectance at normal incidence, 0 to 0.05.
    #[getter]
    fn specular_albedo<'py>(&self, py: Python<'py>) -> Taken<'py> {
        array_of(py, &self.inner.specular_albedo)
    }

    #[setter]
    fn set_specular_albedo(&mut self, array: Given) -> PyResult<()> {
        self.inner.specular_albedo = map_from("specular_albedo", 1, array)?;
        Ok(())
    }

    /// (size, size, 3) unit vectors in object space.
    #[getter]
    fn diffuse_normal<'py>(&self, py: Python<'py>) -> Taken<'py> {
        array_of(py, &self.inner.diffuse_normal)
    }

    #[setter]
    fn set_diffuse_normal(&mut self, array: Given) -> PyResult<()> {
        self.inner.diffuse_normal = map_from("diffuse_normal", 3, array)?;
        Ok(())
    }

    /// (size, size, 3) unit vectors in object space.
    #[getter]
    fn specular_normal<'py>(&self, py: Python<'py>) -> Taken<'py> {
        array_of(py, &self.inner.specular_normal)
    }

    #[setter]
    fn set_specular_normal(&mut self, array: Given) -> PyResult<()> {
        self.inner.specular_normal = map_from("specular_normal", 3, array)?;
        Ok(())
    }

    /// (size, size) 255 where a map had data.
    #[getter]
    fn coverage<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArrayDyn<u8>>>> {
        self.inner.coverage.as_ref().map(|gray| arrays::gray_to_array(py, gray)).transpose()
    }

    #[setter]
    fn set_coverage(&mut self, array: Option<PyReadonlyArrayDyn<u8>>) -> PyResult<()> {
        self.inner.coverage = match array {
            None => None,
            Some(array) => Some(gray_from(&array)?),
        };
        Ok(())
    }
}

fn gray_from(array: &PyReadonlyArrayDyn<u8>) -> PyResult<GrayImage> {
    let array = array.as_array();
    match *array.shape() {
        [height, width] if height == width => {
            Ok(GrayImage { width, height, data: array.iter().copied().collect() })
        }
        ref shape => {
            let reason = format!("coverage: has shape {shape:?}; it must be square");
            Err(named_error("MapsError", &reason))
        }
    }
}
