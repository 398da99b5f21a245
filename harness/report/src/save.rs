//! Writes files and folders of a report.

use std::fs;
use std::path::Path;

use formats::atomic::Folder;

use super::error::ReportError;

/// Writes the folder `out` completely or not at all: `fill` writes its files below the path that it gets. After an
/// error an earlier folder stays as it was.
pub(super) fn write_folder<T, E: From<ReportError>>(
    out: &Path,
    fill: impl FnOnce(&Path) -> Result<T, E>,
) -> Result<T, E> {
    let folder = Folder::begin(out).map_err(ReportError::from)?;
    match fill(folder.path()) {
        Ok(result) => {
            folder.commit().map_err(ReportError::from)?;
            Ok(result)
        }
        Err(error) => {
            folder.abandon();
            Err(error)
        }
    }
}

/// Writes a file, and the folders that it lies in.
pub(super) fn write_file(path: &Path, content: impl AsRef<[u8]>) -> Result<(), ReportError> {
    create_parent(path)?;
    fs::write(path, content).map_err(|error| ReportError::write(path, error))
}

/// Creates the folders that a file lies in.
pub(super) fn create_parent(path: &Path) -> Result<(), ReportError> {
    let Some(folder) = path.parent() else { return Ok(()) };
    fs::create_dir_all(folder).map_err(|error| ReportError::write(folder, error))
}
