//! The solver's readers of picture files for the rendering stages; arrays have row 0 on top.

use std::path::PathBuf;

use formats::picture::{self, Content, ExrFile, GrayImage, Picture, PictureError, Png};
use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray2, PyArray3, PyReadonlyArray3};
use pyo3::prelude::*;

use super::errors::raise;

type Floats<'py> = PyResult<Bound<'py, PyArray3<f32>>>;

/// Channel names, in the file's order.
#[pyfunction]
pub(super) fn exr_channels(py: Python<'_>, path: PathBuf) -> PyResult<Vec<String>> {
    py.detach(|| picture::exr_channel_names(&path)).map_err(raise)
}

/// Channels of an EXR (all of them if `names` is None) and their names; of colours, each R, G, B
/// is converted to linear Rec.709.
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
    let (names, picture) = py.detach(read).map_err(raise)?;
    Ok((names, array(py, picture)?))
}

/// An EXR or Radiance file as linear Rec.709, (height, width, 3).
#[pyfunction]
pub(super) fn read_colour<'py>(py: Python<'py>, path: PathBuf) -> Floats<'py> {
    array(py, py.detach(|| picture::read_colour(&path)).map_err(raise)?)
}

/// A lat-long light as linear Rec.709, (height, width, 3).
#[pyfunction]
pub(super) fn read_light<'py>(py: Python<'py>, path: PathBuf) -> Floats<'py> {
    array(py, py.detach(|| picture::read_light(&path)).map_err(raise)?)
}

/// Writes linear Rec.709 (height, width, 3) as a float EXR; equal pictures give equal bytes.
#[pyfunction]
pub(super) fn write_colour(
    py: Python<'_>,
    path: PathBuf,
    picture: PyReadonlyArray3<f32>,
) -> PyResult<()> {
    let view = picture.as_array();
    let (height, width, channels) = view.dim();
    if channels != 3 {
        return Err(pyo3::exceptions::PyValueError::new_err("picture: expected (h, w, 3)"));
    }
    let picture = Picture { width, height, channels, data: view.iter().copied().collect() };
    py.detach(|| picture::write_exr_rgb(&path, &picture)).map_err(raise)
}

/// A PNG's values from 0 to 1, (height, width, 1) for a grey one, else three channels.
#[pyfunction]
pub(super) fn read_png<'py>(py: Python<'py>, path: PathBuf) -> Floats<'py> {
    array(py, py.detach(|| Png::open(&path)?.picture(&path)).map_err(raise)?)
}

/// An 8-bit grey PNG, (height, width).
#[pyfunction]
pub(super) fn read_gray<'py>(py: Python<'py>, path: PathBuf) -> PyResult<Bound<'py, PyArray2<u8>>> {
    let GrayImage { width, height, data } =
        py.detach(|| picture::read_png_gray(&path)).map_err(raise)?;
    Ok(Array2::from_shape_vec((height, width), data).map_err(shape)?.into_pyarray(py))
}

/// The samples of a PNG of one channel as they are, (height, width).
#[pyfunction]
pub(super) fn read_ids<'py>(py: Python<'py>, path: PathBuf) -> PyResult<Bound<'py, PyArray2<u16>>> {
    let Png { width, height, samples, .. } =
        py.detach(|| Png::open(&path)?.ids(&path)).map_err(raise)?;
    Ok(Array2::from_shape_vec((height, width), samples).map_err(shape)?.into_pyarray(py))
}

pub(super) fn array(py: Python<'_>, picture: Picture) -> PyResult<Bound<'_, PyArray3<f32>>> {
    let Picture { width, height, channels, data } = picture;
    Ok(Array3::from_shape_vec((height, width, channels), data).map_err(shape)?.into_pyarray(py))
}

fn shape(error: numpy::ndarray::ShapeError) -> PyErr {
    pyo3::exceptions::PyValueError::new_err(error.to_string())
}
