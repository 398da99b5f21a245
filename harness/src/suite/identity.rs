//! What a method is, whatever machine or capture it runs on: leaderboards take methods of equal names for one only where
//! this is equal too.

use formats::content_hash::hash_parts;

use super::error::RunError;
use super::method::MethodKind;
use super::preflight::Ready;
use super::sources::SOLVER_SOURCES;

/// A hash of a method's settings and of the content of its files; none of a program that was not found.
pub(super) fn content(ready: &Ready) -> Result<Option<String>, RunError> {
    let parts: Vec<String> = match (&ready.method.kind, &ready.files) {
        (MethodKind::Program(_), None) => return Ok(None),
        (MethodKind::Program(program), Some(files)) => files.content(program)?,
        (MethodKind::Fields { config, .. }, _) => {
            vec![solver::Config::from_toml(config)?.to_toml(), SOLVER_SOURCES.to_owned()]
        }
        (MethodKind::Baseline { baseline, texture_size }, _) => {
            let name = baseline.name().to_owned();
            vec![name, texture_size.to_string(), SOLVER_SOURCES.to_owned()]
        }
        (MethodKind::Competitor { competitor, settings }, _) => {
            vec![competitor.name.to_owned(), settings.clone()]
        }
        (MethodKind::Oracle | MethodKind::LabelMeans, _) => vec![ready.method.id.clone()],
    };
    let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
    Ok(Some(hash_parts(&parts)))
}
