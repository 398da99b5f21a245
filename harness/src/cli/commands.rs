//! The commands, for the command line and for the Python package.

use std::ops::Deref;
use std::path::{Path, PathBuf};

use formats::atomic;
use scoring::score;
use scoring::study::{self, Study};
use solver::{Choice, SolveError};
use view::MethodMaps;

use super::alone::alone;
use super::arguments::{SolveArgs, SolverName, SynthArgs, Verb};
use super::command_line::{command_line, name_of};
use super::outcome::Outcome;
use super::run::run_suite;
use super::{bench, calibrate, check, clean, compare, doctor, figure, seal, start};
use crate::rerun_viewer::{RerunViewer, ViewerError};
use crate::suite::{self, BaselineMethod, Budget, Observer, OwnMetrics, Relight, RunError};
use crate::synth::Tools;

/// Runs the command that a JSON object states: its name as `command`, and its arguments.
pub fn run_request(
    request: &str,
    tools: &Tools,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let wrong = |error: serde_json::Error| RunError::Argument(error.to_string());
    let request: serde_json::Value = serde_json::from_str(request).map_err(wrong)?;
    run(serde_json::from_value(request).map_err(wrong)?, &tools, observer)
}

pub(super) fn run(
    verb: Verb,
    tools: &dyn Deref<Target = Tools>,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    match verb {
        Verb::Synth(arguments) => synth(arguments, tools, observer),
        Verb::Solve(arguments) => solve(&arguments, tools, observer),
        Verb::Relight { capture, maps, out, renderer, light } => {
            let relight = Relight {
                capture: &capture,
                maps: &maps,
                out: &out,
                renderer: &name_of(&renderer),
                scales: &suite::SCALES,
                light: light.as_deref(),
            };
            alone("relight", observer, |step| suite::relight(&relight, tools, step))?;
            Ok(Outcome::default())
        }
        Verb::Budget { capture, maps, out, light, view } => {
            let (light, view) = (light.as_deref(), view.as_deref());
            let budget = Budget { capture: &capture, maps: &maps, out: &out, light, view };
            let found = alone("budget", observer, |step| suite::budget(&budget, tools, step))?;
            Outcome::line(out.join("budget.md").display()).with(&found)
        }
        Verb::Export(export) => {
            let found = alone("export", observer, |step| suite::export(&export, tools, step))?;
            let lines = found["lines"].as_array().into_iter().flatten();
            let lines = lines.map(|line| line.as_str().unwrap_or_default().to_owned()).collect();
            Outcome { lines, ..Outcome::default() }.with(&found)
        }
        Verb::Check { submission: Some(folder), captures, .. } => {
            check::submission(&folder, captures.as_deref(), observer)
        }
        Verb::Check { maps, capture, .. } => {
            check::check(&maps.unwrap_or_default(), capture.as_deref())
        }
        Verb::Seal(arguments) => seal::seal(&arguments, tools, observer),
        Verb::Verify { folder, key } => seal::verify(&folder, key.as_deref()),
        Verb::Score { capture, maps, relit, lpips, metric, out } => {
            let inputs = [Some(&*capture), Some(&*maps), relit.as_deref()];
            atomic::refuse_overlap(&out, &inputs.into_iter().flatten().collect::<Vec<_>>())?;
            let mut scores = score::score(&capture, &maps, relit.as_deref())?;
            if let Some(net) = lpips {
                let rows = suite::lpips(&net, &capture, &maps, relit.as_deref(), tools)?;
                scores.rows.extend(rows);
            }
            let own = OwnMetrics::new(metric, PathBuf::new());
            own.add_rows(&mut scores, [&capture, &maps], relit.as_deref(), tools)?;
            scores.findings.iter().for_each(|finding| observer.message(&finding.to_string()));
            scores.write(&out)?;
            Ok(Outcome::default())
        }
        Verb::Init { folder } => {
            start::write(&folder)?;
            let [suite, run] = ["suite.toml", "run"].map(|name| folder.join(name));
            Ok(Outcome::line(format!("unshade run {} -o {}", suite.display(), run.display())))
        }
        Verb::Run(arguments) => run_suite(arguments, tools, observer),
        Verb::Clean { run, keep, earlier_gb, earlier_days } => {
            let bytes = earlier_gb.map(|gb| (gb * 1e9) as u64);
            let seconds = earlier_days.map(|days| days * 86_400.0);
            clean::clean(&run, &keep, suite::Bound { bytes, seconds }, observer)
        }
        Verb::Report { run, out } => {
            alone("report", observer, |step| suite::report(&run, &out, tools, step))?;
            Ok(Outcome::line(out.join("index.html").display()))
        }
        Verb::View { capture, maps, out } => {
            let methods: Vec<_> = maps.into_iter().map(MethodMaps::named_by_folder).collect();
            let page = alone("view", observer, |_| Ok(view::write(&capture, &methods, &out)?))?;
            Ok(Outcome::line(page.display()))
        }
        Verb::Figure(arguments) => figure::figure(&arguments, tools, observer),
        Verb::Table { runs, out } => {
            report::write_results(&runs, &out, &command_line("table", &runs, &[], Some(&out)))?;
            let mut lines = report::means_in_lines(&runs)?;
            lines.extend(report::failures_in_lines(&runs)?);
            Ok(Outcome { lines, ..Outcome::default() })
        }
        Verb::Compare(arguments) => compare::compare(&arguments, tools, observer),
        Verb::Calibrate(arguments) => calibrate::calibrate(&arguments, tools, observer),
        Verb::Study { runs, out } => study(&runs, out.as_deref()),
        Verb::Site { runs, out } => {
            Ok(Outcome::line(report::write_site(&runs, &out)?.index.display()))
        }
        Verb::Bench(arguments) => bench::bench(&arguments),
        Verb::Doctor { physics } => doctor::examine(tools, physics, observer),
    }
}

fn study(runs: &[PathBuf], out: Option<&Path>) -> Result<Outcome, RunError> {
    let command = command_line("study", runs, &[], out);
    let observations = study::observations(runs)?;
    let found = Study::of(&observations);
    let outcome = match out {
        Some(out) => {
            study::write_study(&found, &observations, runs, out, &command)?;
            Outcome::line(out.join("study.md").display())
        }
        None => Outcome::line(found.markdown(&command).trim_end()),
    };
    outcome.with(&(found, observations))
}

fn synth(
    arguments: SynthArgs,
    tools: &dyn Deref<Target = Tools>,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    // The parser lets no other combination through.
    match (arguments.scene, arguments.contact_sheet, arguments.out) {
        (_, Some(count), Some(out)) => alone("contact sheet", observer, |step| {
            suite::contact_sheet(count, arguments.seed, &out, tools, step)
        })?,
        (Some(scene), _, Some(out)) => {
            alone("synth", observer, |step| suite::synth(&scene, &out, tools, step))?;
        }
        (Some(scene), ..) => return Ok(Outcome::line(suite::describe(&scene, tools)?)),
        _ => {}
    }
    Ok(Outcome::default())
}

fn solve(
    arguments: &SolveArgs,
    tools: &dyn Deref<Target = Tools>,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let mut config = suite::solver_config(&arguments.config)?;
    if arguments.no_records {
        config = config.without_records();
    }
    if arguments.rerun.is_some() && arguments.solver != SolverName::Fields {
        let reason = "a baseline has no steps to show; remove --rerun".to_owned();
        return Err(ViewerError(reason).into());
    }
    if !arguments.given.is_empty() && arguments.solver != SolverName::Fields {
        return Err(SolveError::GivenToOther.into());
    }
    let (capture, out) = (&arguments.capture, &arguments.out);
    let baseline = |method: BaselineMethod| method.make(capture, out, BaselineMethod::TEXTURE_SIZE);
    match arguments.solver {
        SolverName::Fields => {
            let capture = capture::Capture::open(capture)?.with_truth(&arguments.given)?;
            let estimate = solver::memory::Estimate::new(&capture, &config);
            observer.message(&format!("solve: {estimate}"));
            let backend = name_of(&arguments.backend).parse::<Choice>()?.open()?;
            observer.message(&format!("solve: {}", backend.name()));
            let viewer = arguments.rerun.as_deref().map(|place| RerunViewer::open(place, &capture));
            let mut viewer = viewer.transpose()?;
            alone("solve", observer, |bar| {
                let solution =
                    suite::solve(&*backend, &capture, &config, out, tools, &mut |step| {
                        bar(step.iteration as u64, step.total as u64, &suite::in_words(step));
                        viewer.iter_mut().for_each(|viewer| viewer.step(step));
                    })?;
                Ok(viewer.map_or(Ok(()), |viewer| viewer.solution(&solution))?)
            })?;
        }
        SolverName::MeanTexture => baseline(BaselineMethod::MeanTexture)?,
        SolverName::SemanticInitialisation => baseline(BaselineMethod::SemanticInitialisation)?,
        SolverName::LabelMeans => {
            alone("solve", observer, |_| Ok(score::label_mean_maps(capture, out)?))?;
        }
        SolverName::Oracle => alone("solve", observer, |_| Ok(score::oracle_maps(capture, out)?))?,
    }
    Ok(Outcome::default())
}
