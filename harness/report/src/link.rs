//! Relative links from the report to files of the run.

use std::path::{Component, Path, PathBuf};

/// The way from the report's folder to the run's.
#[derive(Clone, Debug)]
pub(super) struct WayToRun(PathBuf);

impl WayToRun {
    /// Both as the user names them; they need not exist.
    pub fn new(run: &Path, report: &Path) -> std::io::Result<Self> {
        Ok(Self(way(&plain(run)?, &plain(report)?)))
    }

    /// A link to a path below the run, encoded as an address.
    pub fn to(&self, below: &Path) -> String {
        encoded(&self.0.join(below))
    }
}

/// A link from a folder to a file, encoded as an address; symbolic links are followed.
pub(super) fn link(file: &Path, folder: &Path) -> String {
    let real = |path: &Path| {
        let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
        absolute.canonicalize().unwrap_or(absolute)
    };
    encoded(&way(&real(file), &real(folder)))
}

/// The relative path to `to` from the folder `from`; both are absolute.
fn way(to: &Path, from: &Path) -> PathBuf {
    let shared = to.components().zip(from.components()).take_while(|(a, b)| a == b).count();
    let up = from.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(to.components().skip(shared)).collect()
}

/// A path as an address: bytes that it may not hold are written as % and hexadecimal digits.
fn encoded(path: &Path) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_./~".contains(&byte);
    let bytes = path.to_string_lossy().replace('\\', "/").into_bytes().into_iter();
    bytes.map(|b| if plain(b) { char::from(b).to_string() } else { format!("%{b:02X}") }).collect()
}

/// Absolute and without `..`.
fn plain(path: &Path) -> std::io::Result<PathBuf> {
    let mut found = PathBuf::new();
    for part in std::path::absolute(path)?.components() {
        match part {
            Component::ParentDir => {
                found.pop();
            }
            part => found.push(part),
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_from_the_report_to_the_run() {
        let way = |run: &str, report: &str| {
            WayToRun::new(Path::new(run), Path::new(report)).unwrap().to(Path::new("maps/a b#.exr"))
        };
        assert_eq!(way("/r/run", "/r/run/report"), "../maps/a%20b%23.exr");
        assert_eq!(way("/r/run", "/r/x/../report"), "../run/maps/a%20b%23.exr");
        assert_eq!(way("/r/run", "/else/deep/report"), "../../../r/run/maps/a%20b%23.exr");
    }
}
