//! The leaderboard: many runs as one page that opens from disk, without a network.
//!
//! The page holds its data as columns of whole numbers, so that a thousand cases are some hundred
//! kilobytes; ranks and intervals are computed where they are shown, for whatever is chosen there.

mod figures;
mod files;
mod gather;

use std::fs;
use std::path::{Path, PathBuf};

use formats::atomic::{self, Folder};

use crate::error::ReportError;
use gather::Board;

const PAGE: &str = include_str!("site.html");
const STYLE: &str = include_str!("site.css");
const SCRIPT: &str = include_str!("site.js");
const STATISTICS: &str = include_str!("statistics.js");

/// Files and size of a written leaderboard.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SiteSummary {
    /// The page to open.
    pub index: PathBuf,
    /// Methods, captures.
    pub entries: usize,
    /// See `entries`.
    pub captures: usize,
}

/// Writes the leaderboard of finished `runs` to the folder `out`, replacing an earlier one.
pub fn write_site(runs: &[PathBuf], out: &Path) -> Result<SiteSummary, ReportError> {
    atomic::refuse_overlap(out, &runs.iter().map(PathBuf::as_path).collect::<Vec<_>>())?;
    let board = Board::of(runs)?;
    let folder = Folder::begin(out)?;
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).map_err(|error| ReportError::write(&path, error))
    };
    let data = files::data(&board, out);
    // No text of a run ends the script that holds it.
    let embedded = data.to_string().replace("</", "<\\/");
    let page = PAGE
        .replace("{{style}}", STYLE)
        .replace("{{statistics}}", STATISTICS)
        .replace("{{script}}", SCRIPT)
        .replace("{{data}}", &embedded);
    let written = write("index.html", &page)
        .and_then(|()| write("leaderboard.json", &data.to_string()))
        .and_then(|()| write("leaderboard.csv", &files::csv(&board)));
    if let Err(error) = written {
        folder.abandon();
        return Err(error);
    }
    folder.commit()?;
    Ok(SiteSummary {
        index: out.join("index.html"),
        entries: board.entries.len(),
        captures: board.captures.len(),
    })
}
