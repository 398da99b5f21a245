//! A command as text, for its results to name.

use std::path::{Path, PathBuf};

use clap::ValueEnum;

/// The name of a choice on the command line.
pub(super) fn name_of(choice: &impl ValueEnum) -> String {
    choice.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

/// `unshade <name> <runs> <options> -o <out>`.
pub(super) fn command_line(
    name: &str,
    runs: &[PathBuf],
    options: &[String],
    out: Option<&Path>,
) -> String {
    let mut words = vec![format!("unshade {name}")];
    words.extend(runs.iter().map(|run| run.display().to_string()));
    words.extend(options.iter().cloned());
    words.extend(out.map(|out| format!("-o {}", out.display())));
    words.join(" ")
}
