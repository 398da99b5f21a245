//! The `unshade` command. Exit codes: 0 done, 1 a check failed, 2 bad input or usage,
//! 3 interrupted.

mod alone;
mod arguments;
mod baseline_branch;
mod bench;
mod calibrate;
mod check;
mod clean;
mod command_line;
mod commands;
mod compare;
mod doctor;
mod exit;
mod figure;
mod groups;
mod outcome;
mod progress;
mod run;
mod seal;
mod start;

use std::cell::LazyCell;
use std::ffi::OsString;
use std::io::Write;

use clap::FromArgMatches;
use tracing_subscriber::filter::LevelFilter;

use arguments::Cli;
pub use commands::run_request;
use exit::{BAD_INPUT, DONE, INTERRUPTED};
pub use outcome::Outcome;
use progress::Progress;

/// Runs the command line `arguments` (the program's name first) and returns the exit code.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let matches = groups::command().try_get_matches_from(arguments);
    let cli = match matches.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(error) => {
            let _ = error.print();
            return if error.use_stderr() { BAD_INPUT } else { DONE };
        }
    };
    let level =
        [LevelFilter::WARN, LevelFilter::INFO, LevelFilter::DEBUG][usize::from(cli.verbose.min(2))];
    let _ = tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(std::io::stderr)
        .without_time()
        .with_target(false)
        .try_init();
    let tools = LazyCell::new(alone::tools);
    let mut progress = Progress::default();
    let outcome = commands::run(cli.verb, &tools, &mut progress);
    progress.finish();
    match outcome {
        Ok(Outcome { code, lines, .. }) => {
            let mut out = std::io::stdout().lock();
            // A reader may have gone, as that of `... | head`.
            let mut show = |line: &String| writeln!(out, "{line}").and_then(|()| out.flush());
            let _ = lines.iter().try_for_each(&mut show);
            code
        }
        Err(error) => {
            eprintln!("unshade: {error}");
            if error.is_interrupt() { INTERRUPTED } else { BAD_INPUT }
        }
    }
}
