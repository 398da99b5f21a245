//! `unshade.Maps`.

use std::path::PathBuf;

use formats::MapsError;
use formats::atomic::Folder;
use formats::picture::{self, GrayImage, Picture};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arrays::{self, Argument};
use super::errors::{named_error, raise};

/// Reflectance maps; what a solver does not recover is None.
///
/// The arrays belong to numpy and are never written to again, so that reading one takes no copy.
#[pyclass(module = "unshade")]
#[derive(Default)]
pub(super) struct Maps {
    floats: [Option<Py<PyArrayDyn<f32>>>; FLOATS.len()],
    coverage: Option<Py<PyArrayDyn<u8>>>,
    interrupted: Option<String>,
}

/// Name and channels of each float map.
const FLOATS: [(&str, usize); 6] = [
    ("diffuse_albedo", 3),
    ("specular_albedo", 1),
    ("diffuse_normal", 3),
    ("specular_normal", 3),
    ("confidence", 1),
    ("roughness", 3),
];
const COVERAGE: &str = "coverage";
/// Key of a pickle beside the maps.
const INTERRUPTED: &str = "interrupted";

type Given<'a, 'py> = Option<&'a Bound<'py, PyAny>>;
type Taken<'py> = PyResult<Option<Bound<'py, PyAny>>>;

fn argument(name: &str) -> Argument<'_> {
    Argument { name, class: "MapsError" }
}

impl Maps {
    /// Maps that were read or solved, their arrays moved.
    pub(super) fn new_from(
        py: Python<'_>,
        maps: formats::Maps,
        interrupted: Option<String>,
    ) -> PyResult<Self> {
        let mut new = Self { interrupted, ..Self::default() };
        let formats::Maps {
            diffuse_albedo,
            specular_albedo,
            diffuse_normal,
            specular_normal,
            confidence,
            roughness,
            coverage,
        } = maps;
        let floats = [
            diffuse_albedo,
            specular_albedo,
            diffuse_normal,
            specular_normal,
            confidence,
            roughness,
        ];
        for (slot, map) in new.floats.iter_mut().zip(floats) {
            *slot = map.map(|map| frozen_picture(py, map)).transpose()?;
        }
        new.coverage = coverage.map(|coverage| frozen_gray(py, coverage)).transpose()?;
        Ok(new)
    }

    /// A copy for the solver's side of the house; texels without coverage that hold no number are
    /// zero in it, because a renderer interpolates across the border.
    pub(super) fn to_solver(&self, py: Python<'_>) -> formats::Maps {
        let coverage = self.coverage_of(py);
        let map = |slot: usize| {
            let mut picture = arrays::picture_of(self.floats[slot].as_ref()?.bind(py));
            picture.data.iter_mut().filter(|value| !value.is_finite()).for_each(|v| *v = 0.0);
            Some(picture)
        };
        formats::Maps {
            diffuse_albedo: map(0),
            specular_albedo: map(1),
            diffuse_normal: map(2),
            specular_normal: map(3),
            confidence: map(4),
            roughness: map(5),
            coverage,
        }
    }

    fn coverage_of(&self, py: Python<'_>) -> Option<GrayImage> {
        let coverage = self.coverage.as_ref()?.bind(py);
        Some(arrays::gray_of(coverage))
    }

    /// Side of the maps that there are, but for the one at `slot`.
    fn side_of_others(&self, py: Python<'_>, slot: usize) -> Option<usize> {
        let others = self.floats.iter().enumerate().filter(|(i, _)| *i != slot);
        let floats = others.filter_map(|(_, map)| Some(arrays::side(map.as_ref()?.bind(py))));
        let coverage = self.coverage.as_ref().filter(|_| slot != FLOATS.len());
        floats.chain(coverage.map(|coverage| arrays::side(coverage.bind(py)))).next()
    }

    fn check_side(&self, py: Python<'_>, slot: usize, found: [usize; 3]) -> PyResult<()> {
        let (name, channels) = FLOATS.get(slot).copied().unwrap_or((COVERAGE, 1));
        let [height, width, planes] = found;
        let side = self.side_of_others(py, slot);
        if width == height && width > 0 && planes == channels && side.is_none_or(|s| s == width) {
            return Ok(());
        }
        let side = side.map_or("size".to_owned(), |side| side.to_string());
        let expected = if channels == 1 {
            format!("({side}, {side})")
        } else {
            format!("({side}, {side}, {channels})")
        };
        let found = if planes == 1 {
            format!("({height}, {width})")
        } else {
            format!("({height}, {width}, {planes})")
        };
        let reason =
            format!("has shape {found}, expected {expected}; maps are square, of one size");
        Err(argument(name).refused(&reason))
    }

    fn get<'py>(&self, py: Python<'py>, slot: usize) -> Taken<'py> {
        self.floats[slot].as_ref().map(|map| map.bind(py).call_method0("view")).transpose()
    }

    fn set(&mut self, py: Python<'_>, slot: usize, value: Given) -> PyResult<()> {
        let name = FLOATS[slot].0;
        let Some(value) = value else {
            self.floats[slot] = None;
            return Ok(());
        };
        let picture = argument(name).picture(value)?;
        self.check_side(py, slot, [picture.height, picture.width, picture.channels])?;
        check_finite(name, &picture, self.coverage_of(py).as_ref())?;
        self.floats[slot] = Some(frozen_picture(py, picture)?);
        Ok(())
    }

    /// Every map that there is, by its name.
    fn by_name<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        // The coverage first: it says which texels of the others count.
        if let Some(coverage) = self.coverage(py)? {
            dict.set_item(COVERAGE, coverage)?;
        }
        for (slot, (name, _)) in FLOATS.iter().enumerate() {
            if let Some(map) = self.get(py, slot)? {
                dict.set_item(name, map)?;
            }
        }
        Ok(dict)
    }
}

#[pymethods]
impl Maps {
    #[new]
    #[pyo3(signature = (*, diffuse_albedo=None, specular_albedo=None, diffuse_normal=None,
                        specular_normal=None, confidence=None, roughness=None, coverage=None))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python<'_>,
        diffuse_albedo: Given,
        specular_albedo: Given,
        diffuse_normal: Given,
        specular_normal: Given,
        confidence: Given,
        roughness: Given,
        coverage: Given,
    ) -> PyResult<Self> {
        let mut maps = Self::default();
        maps.set_coverage(py, coverage)?;
        let floats = [
            diffuse_albedo,
            specular_albedo,
            diffuse_normal,
            specular_normal,
            confidence,
            roughness,
        ];
        for (slot, map) in floats.into_iter().enumerate() {
            maps.set(py, slot, map)?;
        }
        Ok(maps)
    }

    /// Reads whatever maps the folder has.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let inner = py.detach(|| formats::Maps::read(&path)).map_err(raise)?;
        Self::new_from(py, inner, solver::solution::interrupted(&path))
    }

    /// Writes the folder, completely or not at all; `light` becomes its `light.exr`.
    #[pyo3(signature = (path, *, light=None))]
    fn write(&self, py: Python<'_>, path: PathBuf, light: Given) -> PyResult<()> {
        let maps = self.to_solver(py);
        let light = light.map(|light| argument("light").light(light)).transpose()?;
        py.detach(|| {
            let folder = Folder::begin(&path)?;
            maps.write_into(folder.path())?;
            if let Some(light) = &light {
                picture::write_exr_rgb(&folder.path().join("light.exr"), light)?;
            }
            Ok(folder.commit()?)
        })
        .map_err(|error: MapsError| raise(error))
    }

    /// Where the solve was stopped; None for maps of a solve that came to its end.
    #[getter]
    fn interrupted(&self) -> Option<&str> {
        self.interrupted.as_deref()
    }

    /// Texels along a side; None without any map.
    #[getter]
    fn size(&self, py: Python<'_>) -> Option<usize> {
        self.side_of_others(py, usize::MAX)
    }

    /// (size, size, 3) linear Rec.709 reflectance.
    #[getter]
    fn diffuse_albedo<'py>(&self, py: Python<'py>) -> Taken<'py> {
        self.get(py, 0)
    }

    #[setter]
    fn set_diffuse_albedo(&mut self, py: Python<'_>, array: Given) -> PyResult<()> {
        self.set(py, 0, array)
    }

    /// (size, size) reflectance at normal incidence, 0 to 0.05.
    #[getter]
    fn specular_albedo<'py>(&self, py: Python<'py>) -> Taken<'py> {
        self.get(py, 1)
    }

    #[setter]
    fn set_specular_albedo(&mut self, py: Python<'_>, array: Given) -> PyResult<()> {
        self.set(py, 1, array)
    }

    /// (size, size, 3) unit vectors in object space.
    #[getter]
    fn diffuse_normal<'py>(&self, py: Python<'py>) -> Taken<'py> {
        self.get(py, 2)
    }

    #[setter]
    fn set_diffuse_normal(&mut self, py: Python<'_>, array: Given) -> PyResult<()> {
        self.set(py, 2, array)
    }

    /// (size, size, 3) unit vectors in object space.
    #[getter]
    fn specular_normal<'py>(&self, py: Python<'py>) -> Taken<'py> {
        self.get(py, 3)
    }

    #[setter]
    fn set_specular_normal(&mut self, py: Python<'_>, array: Given) -> PyResult<()> {
        self.set(py, 3, array)
    }

    /// (size, size) 0 to 1: the solver's own trust in the diffuse albedo.
    #[getter]
    fn confidence<'py>(&self, py: Python<'py>) -> Taken<'py> {
        self.get(py, 4)
    }

    #[setter]
    fn set_confidence(&mut self, py: Python<'_>, array: Given) -> PyResult<()> {
        self.set(py, 4, array)
    }

    /// (size, size, 3) GGX alphas of the two lobes, and the share of the first.
    #[getter]
    fn roughness<'py>(&self, py: Python<'py>) -> Taken<'py> {
        self.get(py, 5)
    }

    #[setter]
    fn set_roughness(&mut self, py: Python<'_>, array: Given) -> PyResult<()> {
        self.set(py, 5, array)
    }

    /// (size, size) 255 where a map had data.
    #[getter]
    fn coverage<'py>(&self, py: Python<'py>) -> Taken<'py> {
        self.coverage.as_ref().map(|map| map.bind(py).call_method0("view")).transpose()
    }

    #[setter]
    fn set_coverage(&mut self, py: Python<'_>, array: Given) -> PyResult<()> {
        let coverage = array.map(|array| argument(COVERAGE).coverage(array)).transpose()?;
        if let Some(coverage) = &coverage {
            self.check_side(py, FLOATS.len(), [coverage.height, coverage.width, 1])?;
        }
        for (map, (name, _)) in self.floats.iter().zip(FLOATS) {
            if let Some(map) = map {
                check_finite(name, &arrays::picture_of(map.bind(py)), coverage.as_ref())?;
            }
        }
        self.coverage = coverage.map(|coverage| frozen_gray(py, coverage)).transpose()?;
        Ok(())
    }

    /// Equal values in the same maps; where a solve was stopped is no value.
    fn __eq__<'py>(&self, py: Python<'py>, other: &Bound<'py, PyAny>) -> PyResult<Py<PyAny>> {
        let Ok(other) = other.cast::<Self>() else { return Ok(py.NotImplemented()) };
        let (a, b) = (self.by_name(py)?, other.try_borrow()?.by_name(py)?);
        let mut equal = a.len() == b.len();
        let numpy = py.import("numpy")?;
        let options = PyDict::new(py);
        options.set_item("equal_nan", true)?;
        for (name, map) in a.iter() {
            let Some(other) = b.get_item(name)?.filter(|_| equal) else {
                equal = false;
                break;
            };
            equal = numpy.call_method("array_equal", (map, other), Some(&options))?.extract()?;
        }
        Ok(equal.into_pyobject(py)?.to_owned().into_any().unbind())
    }

    /// For pickles and copies.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let this = slf.try_borrow()?;
        let make = py.import("functools")?.getattr("partial")?;
        let make = make.call((slf.get_type(),), Some(&this.by_name(py)?))?;
        let state = PyDict::new(py);
        state.set_item(INTERRUPTED, &this.interrupted)?;
        Ok((make, (), state).into_pyobject(py)?.into_any())
    }

    fn __setstate__(&mut self, state: &Bound<PyDict>) -> PyResult<()> {
        self.interrupted = match state.get_item(INTERRUPTED)? {
            Some(place) => place.extract()?,
            None => None,
        };
        Ok(())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let names: Vec<String> = self.by_name(py)?.keys().extract()?;
        let ordered = FLOATS.iter().map(|(name, _)| *name).chain([COVERAGE]);
        let ordered: Vec<&str> =
            ordered.filter(|name| names.iter().any(|there| there == name)).collect();
        let Some(size) = self.size(py) else { return Ok("Maps(no map)".to_owned()) };
        let stopped =
            self.interrupted.as_ref().map_or(String::new(), |at| format!("; stopped {at}"));
        Ok(format!("Maps({size} x {size}: {}{stopped})", ordered.join(", ")))
    }
}

fn frozen_picture(py: Python<'_>, picture: Picture) -> PyResult<Py<PyArrayDyn<f32>>> {
    let array = arrays::picture_to_array(py, picture)?;
    arrays::freeze(&array)?;
    Ok(array.unbind())
}

fn frozen_gray(py: Python<'_>, gray: GrayImage) -> PyResult<Py<PyArrayDyn<u8>>> {
    let array = arrays::gray_to_array(py, gray)?;
    arrays::freeze(&array)?;
    Ok(array.unbind())
}

/// Refuses a texel that has data and no number in it.
fn check_finite(name: &str, map: &Picture, coverage: Option<&GrayImage>) -> PyResult<()> {
    let counts = |texel: usize| coverage.is_none_or(|coverage| coverage.data[texel] > 127);
    let bad = |(at, value): &(usize, &f32)| !value.is_finite() && counts(at / map.channels);
    let Some((at, value)) = map.data.iter().enumerate().find(bad) else { return Ok(()) };
    let (texel, channel) = (at / map.channels, at % map.channels);
    let (x, y) = (texel % map.width, texel / map.width);
    let mend = match coverage {
        Some(_) => "mend the texel, or take it out of the coverage",
        None => "mend the texel, or say by coverage= where there is data",
    };
    let message = format!("{name}: is {value} at column {x}, row {y}, channel {channel}; {mend}");
    Err(named_error("MapsError", &message))
}
