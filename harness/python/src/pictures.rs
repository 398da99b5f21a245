//! The solver's readers of picture files for the rendering stages; arrays have row 0 on top.

use std::path::PathBuf;

use formats::picture::{self, Content, ExrFile, GrayImage, Picture, PictureError, Png};
use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray2, PyArray3, PyArrayDyn, PyReadonlyArray3};
use pyo3::prelude::*;

use super::arrays::{Argument, picture_to_array};
use super::errors::raise;
use super::threads::detached;

type Floats<'py> = PyResult<Bound<'py, PyArray3<f32>>>;

/// Names of an EXR's channels, from its header; raises ``errors.PictureError``, as all readers
/// here.
#[pyfunction]
pub(super) fn exr_channels(py: Python<'_>, path: PathBuf) -> PyResult<Vec<String>> {
    detached(py, || picture::exr_channel_names(&path))?.map_err(raise)
}

/// Channels (all without ``names``) and their names; (height, width, channels), in the display
/// window.
#[pyfunction]
#[pyo3(signature = (path, names=None, *, colour=false, finite=true))]
pub(super) fn read_exr<'py>(
    py: Python<'py>,
    path: PathBuf,
    names: Option<Vec<String>>,
    colour: bool,
    finite: bool,
) -> PyResult<(Vec<String>, Bound<'py, PyArray3<f32>>)> {
    let content = if colour { Content::Colour } else { Content::Data };
    let read = || {
        let file = ExrFile::open(&path)?;
        let names = names.unwrap_or_else(|| file.channel_names());
        let wanted: Vec<&str> = names.iter().map(String::as_str).collect();
        let picture = file.read(&wanted, content)?;
        if finite {
            picture.require_finite(&path, &wanted)?;
        }
        Ok::<_, PictureError>((names, picture))
    };
    let (names, picture) = detached(py, read)?.map_err(raise)?;
    Ok((names, array(py, picture)?))
}

/// EXR or Radiance as linear Rec.709, (height, width, 3).
#[pyfunction]
pub(super) fn read_colour<'py>(py: Python<'py>, path: PathBuf) -> Floats<'py> {
    array(py, detached(py, || picture::read_colour(&path))?.map_err(raise)?)
}

/// Lat-long pictures of 2 : 1, as linear Rec.709.
#[pyfunction]
pub(super) fn read_light<'py>(py: Python<'py>, path: PathBuf) -> Floats<'py> {
    array(py, detached(py, || picture::read_light(&path))?.map_err(raise)?)
}

/// Linear Rec.709 (height, width, 3) as a float EXR; equal pictures give equal bytes.
#[pyfunction]
pub(super) fn write_colour(
    py: Python<'_>,
    path: PathBuf,
    picture: PyReadonlyArray3<f32>,
) -> PyResult<()> {
    write_exr(py, path, picture, ["R", "G", "B"].map(str::to_owned).to_vec())
}

/// Writes channels (height, width, n) by their names as a float EXR; equal pictures give equal bytes.
#[pyfunction]
pub(super) fn write_exr(
    py: Python<'_>,
    path: PathBuf,
    picture: PyReadonlyArray3<f32>,
    names: Vec<String>,
) -> PyResult<()> {
    let view = picture.as_array();
    let (height, width, channels) = view.dim();
    if channels != names.len() {
        let reason = format!("picture: expected (h, w, {})", names.len());
        return Err(pyo3::exceptions::PyValueError::new_err(reason));
    }
    let picture = Picture { width, height, channels, data: view.iter().copied().collect() };
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    detached(py, || picture::write_exr(&path, &picture, &names))?.map_err(raise)
}

/// A picture as a new array: float32 (height, width[, channels]) of anything that numpy makes floats of. Raises
/// `PictureError` with the argument's name.
#[pyfunction]
pub(super) fn picture_array<'py>(
    name: &str,
    value: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    let picture = Argument { name, class: "PictureError" }.picture(value)?;
    picture_to_array(value.py(), picture)
}

/// Values from 0 to 1, (height, width, 1 or 3).
#[pyfunction]
pub(super) fn read_png<'py>(py: Python<'py>, path: PathBuf) -> Floats<'py> {
    array(py, detached(py, || Png::open(&path)?.picture(&path))?.map_err(raise)?)
}

/// 8-bit grey PNG, (height, width).
#[pyfunction]
pub(super) fn read_gray<'py>(py: Python<'py>, path: PathBuf) -> PyResult<Bound<'py, PyArray2<u8>>> {
    let GrayImage { width, height, data } =
        detached(py, || picture::read_png_gray(&path))?.map_err(raise)?;
    Ok(Array2::from_shape_vec((height, width), data).map_err(shape)?.into_pyarray(py))
}

/// Samples of a PNG of one channel as they are, (height, width).
#[pyfunction]
pub(super) fn read_ids<'py>(py: Python<'py>, path: PathBuf) -> PyResult<Bound<'py, PyArray2<u16>>> {
    let Png { width, height, samples, .. } =
        detached(py, || Png::open(&path)?.ids(&path))?.map_err(raise)?;
    Ok(Array2::from_shape_vec((height, width), samples).map_err(shape)?.into_pyarray(py))
}

pub(super) fn array(py: Python<'_>, picture: Picture) -> PyResult<Bound<'_, PyArray3<f32>>> {
    let Picture { width, height, channels, data } = picture;
    Ok(Array3::from_shape_vec((height, width, channels), data).map_err(shape)?.into_pyarray(py))
}

fn shape(error: numpy::ndarray::ShapeError) -> PyErr {
    pyo3::exceptions::PyValueError::new_err(error.to_string())
}
