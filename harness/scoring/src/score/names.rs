//! Names of captures, maps and relit pictures, from their folders.

use std::fs;
use std::path::Path;

use super::error::ScoreError;

/// The renderer of the pictures, by `relit.json`; none for the truth's own renderer.
pub(super) fn renderer_of(relit: &Path) -> Result<Option<String>, ScoreError> {
    let path = relit.join("relit.json");
    if !path.exists() {
        return Ok(None);
    }
    let bytes = fs::read(&path).map_err(|error| ScoreError::io(&path, error))?;
    let said: serde_json::Value =
        serde_json::from_slice(&bytes).map_err(|error| ScoreError::text(&path, error))?;
    Ok(said["renderer"].as_str().map(str::to_owned))
}

/// The solver's name in `solve.json`, else the folder's name.
pub(super) fn solver_name(maps: &Path) -> Result<String, ScoreError> {
    let path = maps.join("solve.json");
    if !path.exists() {
        return Ok(name_of(maps));
    }
    let bytes = fs::read(&path).map_err(|error| ScoreError::io(&path, error))?;
    let solve: serde_json::Value =
        serde_json::from_slice(&bytes).map_err(|error| ScoreError::text(&path, error))?;
    Ok(solve["solver"].as_str().map_or_else(|| name_of(maps), str::to_owned))
}

pub(super) fn name_of(folder: &Path) -> String {
    folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
