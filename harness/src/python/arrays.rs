//! Pictures as numpy arrays and back: `(height, width, channels)` or `(height, width)`, row 0 on
//! top.

use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArrayDyn, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use solver::picture::{GrayImage, Picture};

fn shape_error(error: numpy::ndarray::ShapeError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A float picture as float32; one channel becomes a plane.
pub(super) fn picture_to_array<'py>(
    py: Python<'py>,
    picture: &Picture,
) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    let shape = (picture.height, picture.width, picture.channels);
    let array =
        Array3::from_shape_vec(shape, picture.data.clone()).map_err(shape_error)?.into_dyn();
    let array = if picture.channels == 1 {
        array.index_axis_move(numpy::ndarray::Axis(2), 0)
    } else {
        array
    };
    Ok(array.into_pyarray(py))
}

/// An 8-bit image as uint8.
pub(super) fn gray_to_array<'py>(
    py: Python<'py>,
    gray: &GrayImage,
) -> PyResult<Bound<'py, PyArrayDyn<u8>>> {
    let array = Array2::from_shape_vec((gray.height, gray.width), gray.data.clone());
    Ok(array.map_err(shape_error)?.into_dyn().into_pyarray(py))
}

/// A float picture from an array of two or three axes; `name` is for the error.
pub(super) fn picture_from_array(name: &str, array: &PyReadonlyArrayDyn<f32>) -> PyResult<Picture> {
    let (height, width, channels) = match *array.shape() {
        [height, width] => (height, width, 1),
        [height, width, channels] => (height, width, channels),
        ref shape => {
            let expected = "expected (height, width) or (height, width, channels)";
            return Err(PyValueError::new_err(format!("{name}: {expected}, got shape {shape:?}")));
        }
    };
    Ok(Picture { width, height, channels, data: array.as_array().iter().copied().collect() })
}

/// A mask from a boolean array of two axes.
pub(super) fn mask_from_array(name: &str, array: &PyReadonlyArrayDyn<bool>) -> PyResult<Vec<bool>> {
    match array.shape() {
        [_, _] => Ok(array.as_array().iter().copied().collect()),
        shape => Err(PyValueError::new_err(format!(
            "{name}: expected (height, width), got shape {shape:?}"
        ))),
    }
}
