//! Arguments of the command line.

use std::path::PathBuf;

use capture::TruthPart;
use clap::{Args, Parser, Subcommand, ValueEnum};
use serde::Deserialize;

use super::bench::BenchArgs;
use super::calibrate::CalibrateArgs;
use super::compare::CompareArgs;
use super::figure::FigureArgs;
use crate::suite::NETS;
use crate::synth::Export;

/// Measures how well a face's reflectance can be recovered from photographs.
#[derive(Parser)]
#[command(name = "unshade", version, max_term_width = 100)]
pub(super) struct Cli {
    #[command(subcommand)]
    pub verb: Verb,
    /// Print more (-v: what each stage does, -vv: everything).
    #[arg(short, long, action = clap::ArgAction::Count, global = true)]
    pub verbose: u8,
}

/// A command, from the command line or from the Python package.
#[derive(Subcommand, Deserialize)]
#[serde(tag = "command", rename_all = "kebab-case")]
pub(super) enum Verb {
    /// Render a capture with its truth from a scene; describe a scene; show many faces.
    Synth(SynthArgs),
    /// Recover reflectance maps from a capture.
    #[serde(skip)]
    Solve(SolveArgs),
    /// Render recovered maps in the capture's lights.
    Relight {
        /// The capture whose scene is rendered.
        capture: PathBuf,
        /// The maps to put on the face.
        maps: PathBuf,
        /// The pictures' folder.
        #[arg(short, long)]
        out: PathBuf,
        /// The path tracer.
        #[arg(long, value_enum, default_value_t = RendererName::Mitsuba)]
        renderer: RendererName,
        /// A lat-long picture (EXR or HDR) to use instead of the capture's lights, with its own radiance.
        #[arg(long, value_name = "FILE")]
        light: Option<PathBuf>,
    },
    /// Attribute a relit view's error to each map (Shapley values).
    Budget {
        /// The capture with its truth.
        capture: PathBuf,
        /// The maps.
        maps: PathBuf,
        /// The output folder.
        #[arg(short, long)]
        out: PathBuf,
        /// The light; by default the capture's own.
        #[arg(long)]
        light: Option<String>,
        /// The withheld view; by default the first.
        #[arg(long)]
        view: Option<String>,
    },
    /// Write maps as an asset for another program, and measure its error.
    Export(Export),
    /// Report likely faults of maps, with evidence and the fix; exit code 1 if there are any.
    Check {
        /// The maps' folder.
        #[arg(required_unless_present = "submission")]
        maps: Option<PathBuf>,
        /// The capture that they were made from; its `truth/` is never opened.
        #[arg(long)]
        capture: Option<PathBuf>,
        /// A submission to check instead: submission.toml and maps/<case>/, or a run's folder with scores.
        #[arg(long, value_name = "FOLDER", conflicts_with_all = ["maps", "capture"])]
        submission: Option<PathBuf>,
        /// The public folder of the round that the submission is for.
        #[arg(long, value_name = "PUBLIC", requires = "submission")]
        captures: Option<PathBuf>,
    },
    /// Score maps and relit pictures against the truth, or against withheld photographs.
    #[serde(skip)]
    Score {
        /// The capture, with its truth or with withheld photographs.
        capture: PathBuf,
        /// The maps to score.
        maps: PathBuf,
        /// The folder of `unshade relight`.
        #[arg(long)]
        relit: Option<PathBuf>,
        /// Also compute LPIPS with this network (needs the extra `lpips`).
        #[arg(long, value_name = "NET", value_parser = NETS)]
        lpips: Option<String>,
        /// Your own metric: module:function, file.py or file.py:function; may be repeated.
        #[arg(long, value_name = "FUNCTION")]
        metric: Vec<String>,
        /// The scores' file.
        #[arg(short, long)]
        out: PathBuf,
    },
    /// Write a suite to start from, with comments, and an example of your own method.
    #[serde(skip)]
    Init {
        /// A new folder, or an empty one.
        folder: PathBuf,
    },
    /// Run a whole suite: render, solve, relight, score, report; resumes where it stopped.
    Run(RunArgs),
    /// Remove outputs that a run can make again; print the size of each kind.
    #[serde(skip)]
    Clean {
        /// The run's folder.
        run: PathBuf,
        /// Kinds of folders to keep, with commas: captures, lights, maps, relit, logs, debug, scores,
        /// report, earlier, store. By default nothing is removed.
        #[arg(long, value_delimiter = ',', value_name = "KINDS")]
        keep: Vec<String>,
        /// Remove the oldest results of earlier settings until at most this many GB (10^9 bytes) are left.
        #[arg(long, value_name = "GB", value_parser = not_negative)]
        earlier_gb: Option<f64>,
        /// Remove results of earlier settings that were replaced more than this many days ago.
        #[arg(long, value_name = "DAYS", value_parser = not_negative)]
        earlier_days: Option<f64>,
    },
    /// Write a run's report: one folder of pages that opens offline.
    Report {
        /// The run's folder.
        run: PathBuf,
        /// The report's folder.
        #[arg(short, long)]
        out: PathBuf,
    },
    /// Write the head in 3D as a page that opens offline: turn it, relight it, see its errors.
    View {
        /// The capture, with its truth or without.
        capture: PathBuf,
        /// The maps to show: up to three folders.
        #[arg(required = true)]
        maps: Vec<PathBuf>,
        /// The page's folder.
        #[arg(short, long)]
        out: PathBuf,
    },
    /// Draw a figure for a paper from finished runs: PNG, PDF, LaTeX, CSV.
    Figure(FigureArgs),
    /// Write the results of finished runs as tables: Markdown, LaTeX or CSV.
    Table {
        /// The runs' folders.
        #[arg(required = true)]
        runs: Vec<PathBuf>,
        /// The file: .md (means over the faces, then face by face), .tex or .csv (the means).
        #[arg(short, long)]
        out: PathBuf,
    },
    /// Compute statistics over the faces of finished runs.
    ///
    /// Means with intervals, paired tests, the number of faces that a study needs, components of variance, fairness
    /// by skin tone.
    Study {
        /// The runs' folders.
        #[arg(required = true)]
        runs: Vec<PathBuf>,
        /// The study's folder (Markdown, JSON, CSV); by default the Markdown is printed.
        #[arg(short, long)]
        out: Option<PathBuf>,
    },
    /// Write finished runs, yours or others', as one leaderboard that opens offline.
    Site {
        /// The runs' folders; captures with equal hashes are joined.
        #[arg(required = true)]
        runs: Vec<PathBuf>,
        /// The leaderboard's folder.
        #[arg(short, long)]
        out: PathBuf,
    },
    /// Render unpublished faces: captures for participants, the truth for the organiser.
    Seal(SealArgs),
    /// Check the signature of sealed scores; exit code 2 if the signature does not match.
    Verify {
        /// The scores' folder.
        folder: PathBuf,
        /// The expected signer: the `public_key` of the round's round.json.
        #[arg(long, value_name = "HEX")]
        key: Option<String>,
    },
    /// Compare a run with a baseline or an earlier run; exit code 1 on a regression.
    Compare(Box<CompareArgs>),
    /// Measure how much a suite's scores depend on the seeds, and write tolerances.
    ///
    /// The tolerances have a known false-alarm rate.
    Calibrate(CalibrateArgs),
    /// Time the solver's kernels and steps against this machine's peak.
    #[serde(skip)]
    Bench(BenchArgs),
    /// Check this machine, and say how to install what is missing.
    #[serde(skip)]
    Doctor {
        /// Also check the renderer against physics; takes minutes. Exit code 1 if a check fails.
        #[arg(long)]
        physics: bool,
    },
}

#[derive(Args, Deserialize)]
pub(super) struct SynthArgs {
    /// The scene to render: a file, or the name of a scene of unshade, such as demo.
    #[arg(required_unless_present = "contact_sheet")]
    pub scene: Option<PathBuf>,
    /// The capture's folder, or the contact sheet's PNG.
    #[arg(short, long, required_unless_present = "describe")]
    pub out: Option<PathBuf>,
    /// Render nothing; print face, cameras, and each light's mean, maximum and colour.
    #[arg(long, conflicts_with_all = ["out", "contact_sheet"], requires = "scene")]
    #[serde(default)]
    pub describe: bool,
    /// Render this many sampled identities into one picture instead.
    #[arg(long, value_name = "N", conflicts_with = "scene",
          value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub contact_sheet: Option<u32>,
    /// The seed of the identities on the contact sheet.
    #[arg(long, default_value_t = 0, requires = "contact_sheet")]
    #[serde(default)]
    pub seed: u64,
}

#[derive(Args)]
pub(super) struct SolveArgs {
    /// The capture; its `truth/` is opened only for what `--given` names.
    pub capture: PathBuf,
    /// The maps' folder.
    #[arg(short, long)]
    pub out: PathBuf,
    /// `fields`, or a baseline.
    #[arg(long, value_enum, default_value_t = SolverName::Fields)]
    pub solver: SolverName,
    /// A preset (unshade, paper, paper-tuned, fast) or a TOML file.
    #[arg(long, default_value = "unshade")]
    pub config: String,
    /// Hold parts at their truth and solve the rest: light, specular, roughness, normals, and highlights or
    /// shading of the training views. Privileged, for studies of errors; needs `unshade` as the method.
    #[arg(long, value_name = "PART=truth", value_delimiter = ',')]
    pub given: Vec<TruthPart>,
    /// Do not write the maps after every stage and the layers of every training view.
    #[arg(long)]
    pub no_records: bool,
    /// The device of the solve.
    #[arg(long, value_enum, default_value_t = BackendName::Auto)]
    pub backend: BackendName,
    /// Show the running solve in the rerun viewer at this address, or write it to a .rrd file.
    /// Needs a program built with `--features rerun`.
    #[arg(long, value_name = "PLACE", num_args = 0..=1,
          default_missing_value = "rerun+http://127.0.0.1:9876/proxy")]
    pub rerun: Option<String>,
}

#[derive(Args, Deserialize)]
pub(super) struct RunArgs {
    /// The suite: a file, or the name of a suite of unshade, such as demo.
    pub suite: PathBuf,
    /// The run's folder.
    #[arg(short, long)]
    pub out: PathBuf,
    /// Run only this method; may be repeated. Valid results of other methods are kept, and a run without this
    /// option resumes from there.
    #[arg(long = "method", value_name = "NAME")]
    #[serde(default)]
    pub methods: Vec<String>,
    /// Run only this case; may be repeated.
    #[arg(long = "case", value_name = "NAME")]
    #[serde(default)]
    pub cases: Vec<String>,
    /// Run this method again even if its results are valid; may be repeated.
    #[arg(long, value_name = "NAME")]
    pub redo: Vec<String>,
    /// Run up to N stages at once, each on its share of the processors, as memory allows.
    #[arg(long, value_name = "N", default_value_t = 1,
          value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: u16,
    /// Run the stages on Dask's workers: the scheduler's address, or `local` to start --jobs workers here (needs
    /// unshade[cluster]).
    #[arg(long, value_name = "ADDRESS", conflicts_with_all = ["redo", "dry_run"])]
    pub cluster: Option<String>,
    /// The store of all machines of the cluster: a shared folder, or a URL of fsspec. By default `store`
    /// in the run's folder.
    #[arg(long, value_name = "URL", requires = "cluster")]
    pub store: Option<String>,
    /// Run nothing; print what is cached, and the time and disc space of the rest.
    #[arg(long)]
    #[serde(default)]
    pub dry_run: bool,
    /// Also estimate from the timings of this run; may be repeated.
    #[arg(long, value_name = "RUN", requires = "dry_run")]
    #[serde(default)]
    pub costs: Vec<PathBuf>,
}

#[derive(Args, Deserialize)]
pub(super) struct SealArgs {
    /// The suite, whose faces get seeds from the secret; its methods are ignored.
    #[arg(required_unless_present = "score")]
    pub suite: Option<PathBuf>,
    /// A secret file of at least 32 random bytes.
    #[arg(long, value_name = "SECRET")]
    pub seeds_from: PathBuf,
    /// The folder for `public` and `private`; with --score, for the signed scores.
    #[arg(short, long)]
    pub out: PathBuf,
    /// The name of the round; each round has other faces.
    #[arg(long, default_value = "1", conflicts_with = "score")]
    pub round: String,
    /// Render up to N captures at once.
    #[arg(long, value_name = "N", default_value_t = 1,
          value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: u16,
    /// Score this submission, and sign the scores.
    #[arg(long, value_name = "SUBMISSION", requires = "private", conflicts_with = "suite")]
    pub score: Option<PathBuf>,
    /// The private folder of the round.
    #[arg(long, value_name = "FOLDER", requires = "score")]
    pub private: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum SolverName {
    /// Neural shading fields.
    Fields,
    /// The mean of the projected colours.
    MeanTexture,
    /// One colour for each label region.
    SemanticInitialisation,
    /// The true mean colour of each label (opens `truth/`).
    LabelMeans,
    /// The true maps (opens `truth/`).
    Oracle,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum BackendName {
    /// A real GPU if there is one, else the CPU.
    Auto,
    /// The CPU.
    Cpu,
    /// A real GPU, or the adapter that UNSHADE_ADAPTER names by a part of its name.
    Gpu,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum RendererName {
    /// Mitsuba, which renders the truth.
    Mitsuba,
    /// Blender's Cycles, an independent renderer (`make cycles`).
    Cycles,
}

fn not_negative(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (0.0..f64::INFINITY).contains(number));
    number.ok_or_else(|| "must be a number from 0".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
