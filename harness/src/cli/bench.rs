//! `unshade bench`.

use std::env;
use std::fs;
use std::path::PathBuf;

use bench::{Options, markdown, run};
use clap::Args;
use formats::atomic;
use solver::backend::gpu::{Adapter, VARIABLE};

use super::outcome::Outcome;
use crate::suite::RunError;

/// Choice of measurements, and where they go. The GPU is the best real one; a software adapter only
/// if UNSHADE_ADAPTER names it.
#[derive(Args)]
pub(super) struct BenchArgs {
    /// Print JSON instead of the tables.
    #[arg(long)]
    json: bool,
    /// Write the output into this file instead.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Also write the tables into this file.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// A Python with PyTorch, to time the same steps.
    #[arg(long, value_name = "PYTHON", env = "UNSHADE_TORCH")]
    torch: Option<PathBuf>,
    /// Also solve this whole capture with `unshade` and `paper`; may be repeated.
    #[arg(long, value_name = "CAPTURE")]
    solve: Vec<PathBuf>,
    /// Test that everything works, at the smallest sizes; the times are meaningless.
    #[arg(long)]
    quick: bool,
}

pub(super) fn bench(arguments: &BenchArgs) -> Result<Outcome, RunError> {
    let BenchArgs { json, out, markdown: page, torch, solve, quick } = arguments;
    // What the user names is looked for before minutes have passed.
    if env::var_os(VARIABLE).is_some_and(|name| !name.is_empty()) {
        Adapter::chosen()?;
    }
    let options =
        Options { quick: *quick, gpu: true, torch: torch.clone(), captures: solve.clone() };
    let report = run(&options, &mut |what| eprintln!("bench: {what}"))?;
    let mut command = "unshade bench".to_owned();
    if torch.is_some() {
        command += " --torch PYTHON";
    }
    for _ in solve {
        command += " --solve CAPTURE";
    }
    if let Some(page) = page {
        command += &format!(" --markdown {}", page.display());
    }
    let tables = markdown(&report, &command);
    if let Some(page) = page {
        atomic::write_file(page, tables.as_bytes())?;
    }
    let text = match json {
        true => serde_json::to_string_pretty(&report).map_err(std::io::Error::other)? + "\n",
        false => tables,
    };
    match out {
        Some(out) => fs::create_dir_all(out.parent().unwrap_or(out.as_path()))
            .and_then(|()| atomic::write_file(out, text.as_bytes()))?,
        None => return Ok(Outcome::line(text.trim_end())),
    }
    Ok(Outcome::default())
}
