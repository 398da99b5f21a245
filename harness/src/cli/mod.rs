//! The `unshade` command. Exit codes: 0 done, 1 a check failed, 2 bad input or usage,
//! 3 interrupted.

/// Prints a line for a reader who may have gone: of `... | head` nobody hears the rest.
macro_rules! say {
    ($($words:tt)*) => {{
        use std::io::Write;
        let mut out = std::io::stdout().lock();
        let _ = writeln!(out, $($words)*).and_then(|()| out.flush());
    }};
}

mod alone;
mod arguments;
mod baseline_branch;
mod bench;
mod calibrate;
mod check;
mod clean;
mod commands;
mod compare;
mod doctor;
mod exit;
mod export;
mod figure;
mod groups;
mod progress;
mod run;
mod seal;
mod start;

use std::ffi::OsString;

use clap::FromArgMatches;
use tracing_subscriber::filter::LevelFilter;

use arguments::Cli;
use exit::{BAD_INPUT, DONE, INTERRUPTED};
pub use figure::figure_request;

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
    match commands::run(cli.verb) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("unshade: {error}");
            if error.is_interrupt() { INTERRUPTED } else { BAD_INPUT }
        }
    }
}
