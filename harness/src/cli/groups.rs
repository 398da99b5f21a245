//! The commands of `unshade --help`, in groups.

use clap::{Command, CommandFactory};

use super::arguments::Cli;

const GROUPS: [(&str, &[&str]); 7] = [
    ("Evaluate", &["init", "run", "report", "view", "score", "relight", "budget", "clean"]),
    ("Methods", &["solve", "check"]),
    ("Captures", &["synth", "import"]),
    ("Assets", &["export"]),
    ("Compare", &["compare", "calibrate", "study", "table", "figure"]),
    ("Share", &["site", "seal", "verify"]),
    ("This machine", &["doctor", "bench"]),
];

/// The command that the Python package answers itself.
const IMPORT: &str =
    "Import photographs, cameras and a mesh of other programs, or maps of other methods.";

/// The command line with its commands in groups.
pub(super) fn command() -> Command {
    let command = Cli::command();
    let about = |name: &str| match command.find_subcommand(name).and_then(Command::get_about) {
        Some(about) => about.to_string(),
        None => IMPORT.to_owned(),
    };
    let group = |(title, names): &(&str, &[&str])| {
        let lines = names.iter().map(|name| format!("  {name:<11}{}\n", about(name)));
        format!("{title}:\n{}\n", lines.collect::<String>())
    };
    let groups: String = GROUPS.iter().map(group).collect();
    let template = format!(
        "{{about}}\n\n{{usage-heading}} {{usage}}\n\n{groups}Options:\n{{options}}\n\n\
         unshade COMMAND --help: the arguments of a command"
    );
    command.help_template(template)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_is_in_one_group_and_on_one_line() {
        let mut grouped: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| *names).copied().collect();
        let command = command();
        let mut known: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
        known.push("import");
        grouped.sort_unstable();
        known.sort_unstable();
        assert_eq!(grouped, known);
        let help = command.clone().render_help().to_string();
        for line in help.lines() {
            assert!(line.chars().count() <= 100, "{line}");
        }
    }
}
