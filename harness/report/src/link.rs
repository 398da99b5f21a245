//! Where a file of the run lies as seen from the report: a relative link.

use std::path::{Component, Path, PathBuf};

/// The way from the report's folder to the run's.
#[derive(Clone, Debug)]
pub(super) struct WayToRun(PathBuf);

impl WayToRun {
    /// Both as the user names them; they need not exist.
    pub fn new(run: &Path, report: &Path) -> std::io::Result<Self> {
        let (run, report) = (plain(run)?, plain(report)?);
        let shared = run.components().zip(report.components()).take_while(|(a, b)| a == b).count();
        let up = report.components().skip(shared).map(|_| Component::ParentDir);
        Ok(Self(up.chain(run.components().skip(shared)).collect()))
    }

    /// A link to a path below the run, encoded as an address.
    pub fn to(&self, below: &Path) -> String {
        let path = self.0.join(below);
        let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_./~".contains(&byte);
        let bytes = path.to_string_lossy().replace('\\', "/").into_bytes().into_iter();
        bytes
            .map(|b| if plain(b) { char::from(b).to_string() } else { format!("%{b:02X}") })
            .collect()
    }
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
