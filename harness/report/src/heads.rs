//! The page of each case's head, which is turned and relit in the browser; its data are loaded when it is opened.

use std::fs;
use std::path::Path;

use serde::Serialize;
use view::{MOST_METHODS, MethodMaps};

use super::comparison_figures::MethodFolders;
use super::error::ReportError;
use super::run::{Case, Kind};

/// The folder of all heads, with the viewer that their pages share.
const FOLDER: &str = "heads";

/// The head's page, or the reason why there is none.
#[derive(Serialize)]
pub(super) struct Head {
    page: Option<String>,
    reason: Option<String>,
}

/// The page of the case with this [file name](super::comparison_figures::file_name), below the report's folder.
pub(super) fn page_of(anchor: &str) -> String {
    format!("{FOLDER}/{anchor}/index.html")
}

/// Writes the viewer for the pages of [`Head::write`] below the report's folder.
pub(super) fn write_viewer(root: &Path) -> Result<(), ReportError> {
    let folder = root.join(FOLDER);
    fs::create_dir_all(&folder).map_err(|error| ReportError::write(&folder, error))?;
    Ok(view::write_shared(&folder)?)
}

impl Head {
    /// Writes the page of a case, with the maps of its first methods; an oracle's are the truth's.
    pub fn write(
        case: &Case,
        capture: &Path,
        methods: &[MethodFolders],
        anchor: &str,
        root: &Path,
    ) -> Result<Self, ReportError> {
        let below = format!("{FOLDER}/{anchor}");
        let folder = root.join(&below);
        let with_albedo = methods.iter().filter_map(|method| {
            let folder = method.maps.clone()?;
            let MethodFolders { column, .. } = method;
            let is_shown =
                column.method.kind != Kind::Oracle && folder.join("diffuse_albedo.exr").is_file();
            is_shown.then(|| MethodMaps { title: column.method.title().to_owned(), folder })
        });
        let shown: Vec<MethodMaps> = with_albedo.take(MOST_METHODS).collect();
        fs::create_dir_all(&folder).map_err(|error| ReportError::write(&folder, error))?;
        match view::write_head(capture, &shown, &case.id, &folder, "../") {
            Ok(()) => Ok(Self { page: Some(page_of(anchor)), reason: None }),
            Err(error @ view::ViewError::Write { .. }) => Err(error.into()),
            Err(error) => {
                fs::remove_dir_all(&folder).map_err(|error| ReportError::write(&folder, error))?;
                Ok(Self { page: None, reason: Some(error.to_string()) })
            }
        }
    }
}
