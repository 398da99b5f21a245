//! The leaderboard: many runs as one page that opens from disk, without a network.
//!
//! The page holds its data as columns of whole numbers, so that a thousand cases are some hundred
//! kilobytes; ranks and intervals are computed where they are shown, for whatever is chosen there.

mod figures;
mod files;
mod gather;

use std::path::{Path, PathBuf};

use formats::atomic;

use crate::error::ReportError;
use crate::save::{write_file, write_folder};
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
    let data = files::data(&board, out);
    // No text of a run ends the script that holds it.
    let embedded = data.to_string().replace("</", "<\\/");
    let page = PAGE
        .replace("{{style}}", STYLE)
        .replace("{{statistics}}", STATISTICS)
        .replace("{{script}}", SCRIPT)
        .replace("{{data}}", &embedded);
    write_folder::<_, ReportError>(out, |folder| {
        write_file(&folder.join("index.html"), &page)?;
        write_file(&folder.join("leaderboard.json"), data.to_string())?;
        write_file(&folder.join("leaderboard.csv"), files::csv(&board))
    })?;
    Ok(SiteSummary {
        index: out.join("index.html"),
        entries: board.entries.len(),
        captures: board.captures.len(),
    })
}
