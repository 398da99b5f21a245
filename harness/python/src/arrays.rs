//! Pictures as numpy arrays and back: `(height, width, channels)` or `(height, width)`, row 0 on
//! top.
//!
//! Whatever numpy makes an array of is taken (float of any width, signed integers, nested lists, any
//! strides); what cannot be meant is refused by the argument's name.

use formats::picture::{GrayImage, Picture};
use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArrayDyn, PyReadonlyArray2, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::errors::named_error;

fn shape_error(error: numpy::ndarray::ShapeError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A float picture as float32; one channel becomes a plane.
pub(super) fn picture_to_array<'py>(
    py: Python<'py>,
    picture: Picture,
) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    let shape = (picture.height, picture.width, picture.channels);
    let array = Array3::from_shape_vec(shape, picture.data).map_err(shape_error)?.into_dyn();
    let array = if picture.channels == 1 {
        array.index_axis_move(numpy::ndarray::Axis(2), 0)
    } else {
        array
    };
    Ok(array.into_pyarray(py))
}

/// The rows of an array (n, N); raises ValueError with the argument's name for another shape.
pub(super) fn rows<T: numpy::Element + Copy, const N: usize>(
    name: &str,
    array: &PyReadonlyArray2<T>,
) -> PyResult<Vec<[T; N]>> {
    let view = array.as_array();
    if view.ncols() != N {
        let shape = array.shape();
        return Err(PyValueError::new_err(format!("{name}: expected (n, {N}), got {shape:?}")));
    }
    Ok(view.rows().into_iter().map(|row| std::array::from_fn(|axis| row[axis])).collect())
}

/// An 8-bit image as uint8.
pub(super) fn gray_to_array<'py>(
    py: Python<'py>,
    gray: GrayImage,
) -> PyResult<Bound<'py, PyArrayDyn<u8>>> {
    let array = Array2::from_shape_vec((gray.height, gray.width), gray.data);
    Ok(array.map_err(shape_error)?.into_dyn().into_pyarray(py))
}

/// An argument that should be an array: its name and the exception of `unshade.errors` (or
/// `ValueError`) that is raised if it cannot be meant.
#[derive(Clone, Copy)]
pub(super) struct Argument<'a> {
    pub name: &'a str,
    pub class: &'static str,
}

impl Argument<'_> {
    /// The exception with the argument's name in front.
    pub(super) fn refused(self, reason: &str) -> PyErr {
        let message = format!("{}: {reason}", self.name);
        named_error(self.class, &message)
    }

    /// A float picture of two or three axes; float64 is rounded to float32.
    pub(super) fn picture(self, value: &Bound<PyAny>) -> PyResult<Picture> {
        let array = self.array(value, "a float array (height, width[, channels])")?;
        let kind = kind(&array)?;
        let (height, width, channels) = match *shape(&array)? {
            [height, width] => (height, width, 1),
            [height, width, channels] => (height, width, channels),
            ref shape => {
                let expected = "expected (height, width) or (height, width, channels)";
                return Err(self.refused(&format!("{expected}, got shape {shape:?}")));
            }
        };
        let data = match kind {
            'f' if array.getattr("itemsize")?.extract::<usize>()? <= 4 => floats(&array)?,
            // Rounded here: numpy warns of what overflows, which is reported by its place later.
            'f' | 'i' => doubles(&array)?.iter().map(|value| *value as f32).collect(),
            'u' => {
                return Err(self.refused(&format!(
                    "has dtype {}, the codes of an encoded picture; give linear values as float32",
                    dtype(&array)?
                )));
            }
            _ => {
                let reason = format!("has dtype {}; give float32", dtype(&array)?);
                return Err(self.refused(&reason));
            }
        };
        Ok(Picture { width, height, channels, data })
    }

    /// A light: finite radiance of the whole sphere, lat-long, three channels, twice as wide as high.
    pub(super) fn light(self, value: &Bound<PyAny>) -> PyResult<Picture> {
        let light = self.picture(value)?;
        if light.channels != 3 || light.width != 2 * light.height {
            let shape = (light.height, light.width, light.channels);
            return Err(self.refused(&format!("expected (rows, 2 x rows, 3), got shape {shape:?}")));
        }
        match light.data.iter().find(|value| !value.is_finite()) {
            Some(value) => Err(self.refused(&format!("holds {value}; fix the pixel"))),
            None => Ok(light),
        }
    }

    /// A mask of 0 and 255 from booleans, from zeros and ones of any type, or from integers up to
    /// 255, of which those above 127 are inside, as in the masks of a capture.
    pub(super) fn mask(self, value: &Bound<PyAny>) -> PyResult<GrayImage> {
        let values = self.plane(value, "give bool, or uint8 of 0 to 255")?;
        let binary = values.data.iter().all(|value| *value == 0.0 || *value == 1.0);
        if !binary {
            self.check_bytes(&values.data, "give bool, or uint8 of 0 to 255")?;
        }
        let inside = |value: &f64| *value > if binary { 0.0 } else { 127.0 };
        Ok(GrayImage {
            width: values.width,
            height: values.height,
            data: values.data.iter().map(|value| if inside(value) { 255 } else { 0 }).collect(),
        })
    }

    /// An image of whole numbers from 0 to 255: region ids, or a map's coverage as its file has it.
    pub(super) fn bytes(self, value: &Bound<PyAny>) -> PyResult<GrayImage> {
        let values = self.plane(value, "give uint8")?;
        self.check_bytes(&values.data, "give uint8")?;
        let data = values.data.iter().map(|value| *value as u8).collect();
        Ok(GrayImage { width: values.width, height: values.height, data })
    }

    /// The coverage of maps: as its file has it, or booleans (zeros and ones).
    pub(super) fn coverage(self, value: &Bound<PyAny>) -> PyResult<GrayImage> {
        let mut coverage = self.bytes(value)?;
        if coverage.data.iter().all(|value| *value <= 1) {
            coverage.data.iter_mut().for_each(|value| *value *= 255);
        }
        Ok(coverage)
    }

    fn check_bytes(self, values: &[f64], fix: &str) -> PyResult<()> {
        let odd = |value: &&f64| !(0.0..=255.0).contains(*value) || value.fract() != 0.0;
        match values.iter().find(odd) {
            None => Ok(()),
            Some(value) => Err(self.refused(&format!("holds {value}; {fix}"))),
        }
    }

    /// Numbers or booleans of two axes.
    fn plane(self, value: &Bound<PyAny>, fix: &str) -> PyResult<Plane> {
        let array = self.array(value, "an array (height, width)")?;
        let [height, width] = *shape(&array)? else {
            let reason = format!("expected (height, width), got shape {:?}", shape(&array)?);
            return Err(self.refused(&reason));
        };
        if !matches!(kind(&array)?, 'b' | 'u' | 'i' | 'f') {
            return Err(self.refused(&format!("has dtype {}; {fix}", dtype(&array)?)));
        }
        Ok(Plane { width, height, data: doubles(&array)? })
    }

    /// `numpy.asarray`, which takes nested lists, tensors and views alike.
    fn array<'py>(self, value: &Bound<'py, PyAny>, expected: &str) -> PyResult<Bound<'py, PyAny>> {
        let numpy = value.py().import("numpy")?;
        if value.is_instance(&numpy.getattr("ma")?.getattr("MaskedArray")?)? {
            let reason =
                "is a masked array, whose own mask would be lost; give its filled() values";
            return Err(self.refused(reason));
        }
        let array = match numpy.call_method1("asarray", (value,)) {
            // Ragged lists are no array; None is one of an object, and a file's name one of letters.
            Err(error) if error.is_instance_of::<PyValueError>(value.py()) => None,
            array => {
                Some(array?).filter(|array| kind(array).is_ok_and(|kind| !"OSUV".contains(kind)))
            }
        };
        let given = value.get_type().qualname()?;
        array.ok_or_else(|| self.refused(&format!("expected {expected}, got {given}")))
    }
}

/// Values of two axes, row-major.
struct Plane {
    width: usize,
    height: usize,
    data: Vec<f64>,
}

fn shape(array: &Bound<PyAny>) -> PyResult<Vec<usize>> {
    array.getattr("shape")?.extract()
}

/// numpy's letter for the kind of number.
fn kind(array: &Bound<PyAny>) -> PyResult<char> {
    array.getattr("dtype")?.getattr("kind")?.extract()
}

fn dtype(array: &Bound<PyAny>) -> PyResult<String> {
    Ok(array.getattr("dtype")?.str()?.to_string())
}

/// The values of a float array of at most 32 bits in row-major order, whatever its byte order and
/// strides.
fn floats(array: &Bound<PyAny>) -> PyResult<Vec<f32>> {
    let array = array.call_method1("astype", ("float32", "C"))?;
    let array: PyReadonlyArrayDyn<f32> = array.extract()?;
    Ok(array.as_array().iter().copied().collect())
}

/// The values in row-major order, whatever their type, byte order and strides.
fn doubles(array: &Bound<PyAny>) -> PyResult<Vec<f64>> {
    let array = array.call_method1("astype", ("float64", "C"))?;
    let array: PyReadonlyArrayDyn<f64> = array.extract()?;
    Ok(array.as_array().iter().copied().collect())
}

/// A copy of an array of ours as a picture.
pub(super) fn picture_of(array: &PyReadonlyArrayDyn<f32>) -> Picture {
    let view = array.as_array();
    let (height, width) = (view.shape()[0], view.shape()[1]);
    let channels = view.shape().get(2).copied().unwrap_or(1);
    Picture { width, height, channels, data: view.iter().copied().collect() }
}

/// A copy of an array of ours as an 8-bit image.
pub(super) fn gray_of(array: &PyReadonlyArrayDyn<u8>) -> GrayImage {
    let view = array.as_array();
    let (height, width) = (view.shape()[0], view.shape()[1]);
    GrayImage { width, height, data: view.iter().copied().collect() }
}
