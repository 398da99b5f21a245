//! Maps as numpy arrays by name; `unshade.Maps` holds them.

use std::path::PathBuf;

use formats::atomic::Folder;
use formats::picture::{self, Picture};
use formats::{Maps, MapsError};
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arrays::{self, Argument};
use super::errors::raise;
use super::threads::detached;

const COVERAGE: &str = "coverage";

/// The float maps by their names.
fn floats(maps: &mut Maps) -> [(&'static str, &mut Option<Picture>); 6] {
    [
        ("diffuse_albedo", &mut maps.diffuse_albedo),
        ("specular_albedo", &mut maps.specular_albedo),
        ("diffuse_normal", &mut maps.diffuse_normal),
        ("specular_normal", &mut maps.specular_normal),
        ("confidence", &mut maps.confidence),
        ("roughness", &mut maps.roughness),
    ]
}

/// Arrays by name, moved.
pub(super) fn to_dict(py: Python<'_>, mut maps: Maps) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    for (name, map) in floats(&mut maps) {
        if let Some(map) = map.take() {
            dict.set_item(name, arrays::picture_to_array(py, map)?)?;
        }
    }
    if let Some(coverage) = maps.coverage {
        dict.set_item(COVERAGE, arrays::gray_to_array(py, coverage)?)?;
    }
    Ok(dict)
}

/// The maps of a folder by name, and where the solve was stopped.
#[pyfunction]
pub(super) fn read_maps(
    py: Python<'_>,
    path: PathBuf,
) -> PyResult<(Bound<'_, PyDict>, Option<String>)> {
    let maps = detached(py, || Maps::read(&path))?.map_err(raise)?;
    Ok((to_dict(py, maps)?, solver::solution::interrupted(&path)))
}

/// Writes maps, arrays as `map_array` returns them by name, completely or not at all. Texels that hold no number
/// are written as 0, because a renderer interpolates across the border of the coverage. `light` becomes `light.exr`.
#[pyfunction]
#[pyo3(signature = (maps, path, light=None))]
pub(super) fn write_maps(
    py: Python<'_>,
    maps: &Bound<PyDict>,
    path: PathBuf,
    light: Option<&Bound<PyAny>>,
) -> PyResult<()> {
    let light = light
        .map(|light| Argument { name: "light", class: "MapsError" }.light(light))
        .transpose()?;
    let mut own = Maps::default();
    for (name, slot) in floats(&mut own) {
        let Some(array) = maps.get_item(name)? else { continue };
        let mut picture = arrays::picture_of(&array.extract::<PyReadonlyArrayDyn<f32>>()?);
        picture.data.iter_mut().filter(|value| !value.is_finite()).for_each(|v| *v = 0.0);
        *slot = Some(picture);
    }
    if let Some(coverage) = maps.get_item(COVERAGE)? {
        own.coverage = Some(arrays::gray_of(&coverage.extract::<PyReadonlyArrayDyn<u8>>()?));
    }
    let write = || {
        let folder = Folder::begin(&path)?;
        own.write_into(folder.path())?;
        if let Some(light) = &light {
            picture::write_exr_rgb(&folder.path().join("light.exr"), light)?;
        }
        Ok(folder.commit()?)
    };
    detached(py, write)?.map_err(|error: MapsError| raise(error))
}

/// A map as a new array: float32 (height, width[, channels]) of anything that numpy makes floats of. Raises
/// `MapsError` with the map's name.
#[pyfunction]
pub(super) fn map_array<'py>(
    name: &str,
    value: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    let picture = Argument { name, class: "MapsError" }.picture(value)?;
    arrays::picture_to_array(value.py(), picture)
}

/// A coverage as a new array: uint8 (height, width), 0 and 255 of booleans. Raises `MapsError`.
#[pyfunction]
pub(super) fn coverage_array<'py>(
    value: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArrayDyn<u8>>> {
    let coverage = Argument { name: COVERAGE, class: "MapsError" }.coverage(value)?;
    arrays::gray_to_array(value.py(), coverage)
}
