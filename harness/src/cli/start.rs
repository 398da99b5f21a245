//! `unshade init`: a suite to start from, and your own method.

use std::path::Path;
use std::{fs, io};

use formats::atomic::write_file;

use crate::suite::RunError;

/// The suite comes last: where it is, all is.
const FILES: [(&str, &str); 2] =
    [("mine.py", include_str!("start/mine.py")), ("suite.toml", include_str!("start/suite.toml"))];

/// Writes the files into `folder`, which is new or empty.
pub(super) fn write(folder: &Path) -> Result<(), RunError> {
    let failed = |reason| RunError::File { path: folder.to_path_buf(), reason };
    match fs::read_dir(folder).map(|mut entries| entries.next().is_some()) {
        Ok(true) => {
            let reason = "is not empty; name a new folder or an empty one";
            return Err(failed(io::Error::other(reason)));
        }
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(failed(error)),
        _ => {}
    }
    let mut files = FILES.iter().map(|(name, text)| (folder.join(name), text));
    let written = fs::create_dir_all(folder)
        .and_then(|()| files.try_for_each(|(path, text)| write_file(&path, text.as_bytes())));
    if written.is_err() {
        FILES.iter().for_each(|(name, _)| drop(fs::remove_file(folder.join(name))));
    }
    written.map_err(failed)
}
