//! Folders that appear completely or not at all, for the stages that are written in Python.

use std::path::PathBuf;

use formats::atomic::Folder;
use pyo3::prelude::*;

use super::errors::raise;
use super::threads::detached;

/// Starts the folder `target`, or takes up an attempt with the same key; returns where to write.
/// Raises `StorageError` if the target is not unshade's to replace.
#[pyfunction]
pub(super) fn begin_folder(target: PathBuf, key: &str) -> PyResult<PathBuf> {
    Ok(Folder::resume(&target, key).map_err(raise)?.path().to_path_buf())
}

/// Puts the folder that `begin_folder` started with these arguments in the target's place.
#[pyfunction]
pub(super) fn commit_folder(py: Python<'_>, target: PathBuf, key: &str) -> PyResult<()> {
    detached(py, || Folder::resume(&target, key)?.commit())?.map_err(raise)
}
