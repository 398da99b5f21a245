//! What each verb does.

use std::fs;
use std::path::Path;
use std::time::Instant;

use formats::atomic;
use scoring::compare::{Baseline, Tolerances, compare};
use scoring::score;
use solver::Choice;

use super::alone::{alone, tools};
use super::arguments::{
    BackendName, CompareArgs, RendererName, SolveArgs, SolverName, SynthArgs, Verb,
};
use super::exit::{CHECK_FAILED, DONE};
use super::progress::Progress;
use super::{bench, check, doctor, export, figure, start};
use crate::rerun_viewer::{RerunViewer, ViewerError};
use crate::suite::{self, BaselineMethod, RunError, RunOptions, Suite};

pub(super) fn run(verb: Verb) -> Result<u8, RunError> {
    match verb {
        Verb::Synth(arguments) => synth(arguments)?,
        Verb::Solve(arguments) => solve(&arguments)?,
        Verb::Relight { capture, maps, out, renderer } => {
            let renderer = match renderer {
                RendererName::Mitsuba => "mitsuba",
                RendererName::Cycles => "cycles",
            };
            alone("relight", |tools, step| {
                suite::relight(renderer, &capture, &maps, &out, &suite::SCALES, tools, step)
            })?;
        }
        Verb::Export(arguments) => export::export(&arguments)?,
        Verb::Check { maps, capture } => return Ok(check::check(&maps, capture.as_deref())?),
        Verb::Score { capture, maps, relit, out } => {
            let inputs = [Some(&*capture), Some(&*maps), relit.as_deref()];
            atomic::refuse_overlap(&out, &inputs.into_iter().flatten().collect::<Vec<_>>())?;
            let scores = score::score(&capture, &maps, relit.as_deref())?;
            scores.findings.iter().for_each(|finding| eprintln!("{finding}"));
            scores.write(&out)?;
        }
        Verb::Init { folder } => {
            start::write(&folder)?;
            say!(
                "unshade run {} -o {}",
                folder.join("suite.toml").display(),
                folder.join("run").display()
            );
        }
        Verb::Run { suite, out, redo } => return run_suite(&suite, &out, RunOptions { redo }),
        Verb::Report { run, out } => {
            alone("report", |tools, step| suite::report(&run, &out, tools, step))?;
            say!("{}", out.join("index.html").display());
        }
        Verb::Figure(arguments) => figure::figure(&arguments)?,
        Verb::Table { runs, out } => {
            let mut words = vec!["unshade table".to_owned()];
            words.extend(runs.iter().map(|run| run.display().to_string()));
            words.push(format!("-o {}", out.display()));
            report::write_results(&runs, &out, &words.join(" "))?;
        }
        Verb::Compare(arguments) => return compare_run(&arguments),
        Verb::Bench(arguments) => bench::bench(&arguments)?,
        Verb::Doctor { physics } => return doctor::examine(&tools(), physics),
    }
    Ok(DONE)
}

fn synth(arguments: SynthArgs) -> Result<(), RunError> {
    // The parser lets no other combination through.
    match (arguments.scene, arguments.contact_sheet, arguments.out) {
        (_, Some(count), Some(out)) => alone("contact sheet", |tools, step| {
            suite::contact_sheet(count, arguments.seed, &out, tools, step)
        }),
        (Some(scene), _, Some(out)) => {
            alone("synth", |tools, step| suite::synth(&scene, &out, tools, step))
        }
        (Some(scene), ..) => {
            say!("{}", suite::describe(&scene, &tools())?);
            Ok(())
        }
        _ => Ok(()),
    }
}

fn solve(arguments: &SolveArgs) -> Result<(), RunError> {
    let mut config = if arguments.config.ends_with(".toml") {
        let path = std::path::PathBuf::from(&arguments.config);
        let text = fs::read_to_string(&path);
        solver::Config::from_toml(&text.map_err(|reason| RunError::File { path, reason })?)?
    } else {
        solver::Config::preset(&arguments.config)?
    };
    if arguments.no_records {
        config.records = solver::config::RecordConfig { stages: false, layers: false };
    }
    if arguments.rerun.is_some() && arguments.solver != SolverName::Fields {
        let reason = "a baseline has no steps to show; leave it out".to_owned();
        return Err(ViewerError(reason).into());
    }
    let (capture, out) = (&arguments.capture, &arguments.out);
    match arguments.solver {
        SolverName::Fields => {
            let capture = capture::Capture::open(capture)?;
            eprintln!("solve: {}", solver::memory::Estimate::new(&capture, &config));
            let backend = match arguments.backend {
                BackendName::Auto => Choice::Auto,
                BackendName::Cpu => Choice::Cpu,
                BackendName::Gpu => Choice::Gpu,
            };
            let backend = backend.open()?;
            eprintln!("solve: {}", backend.name());
            let viewer = arguments.rerun.as_deref().map(|place| RerunViewer::open(place, &capture));
            let mut viewer = viewer.transpose()?;
            alone("solve", |tools, bar| {
                let solution =
                    suite::solve(&*backend, &capture, &config, out, tools, &mut |step| {
                        bar(step.iteration as u64, step.total as u64, &suite::in_words(step));
                        viewer.iter_mut().for_each(|viewer| viewer.step(step));
                    })?;
                Ok(viewer.map_or(Ok(()), |viewer| viewer.solution(&solution))?)
            })
        }
        SolverName::MeanTexture => baseline(BaselineMethod::MeanTexture, arguments),
        SolverName::SemanticInitialisation => {
            baseline(BaselineMethod::SemanticInitialisation, arguments)
        }
        SolverName::LabelMeans => alone("solve", |_, _| Ok(score::label_mean_maps(capture, out)?)),
        SolverName::Oracle => alone("solve", |_, _| Ok(score::oracle_maps(capture, out)?)),
    }
}

fn baseline(method: BaselineMethod, arguments: &SolveArgs) -> Result<(), RunError> {
    method.make(&arguments.capture, &arguments.out, BaselineMethod::TEXTURE_SIZE)
}

fn run_suite(suite: &Path, out: &Path, options: RunOptions) -> Result<u8, RunError> {
    let suite = Suite::open(suite)?;
    let mut progress = Progress::new();
    let start = Instant::now();
    let summary = suite::run(&suite, out, &options, &tools(), &mut progress);
    progress.finish();
    let summary = summary?;
    let seconds = start.elapsed().as_secs_f64();
    let (ran, skipped) = (summary.ran, summary.skipped);
    eprintln!("{ran} stages run, {skipped} still valid, {seconds:.0} s");
    say!("{}", summary.report.display());
    for (name, reason) in &summary.failed {
        eprintln!("unshade: {name} failed: {reason}");
    }
    Ok(if summary.failed.is_empty() { DONE } else { CHECK_FAILED })
}

fn compare_run(arguments: &CompareArgs) -> Result<u8, RunError> {
    let tolerances = match &arguments.tolerances {
        Some(path) => Tolerances::read(path)?,
        None => Tolerances::built_in()?,
    };
    let current = Baseline::of_run(&arguments.run)?;
    let comparison = compare(&current, &Baseline::read(&arguments.baseline)?, &tolerances)?;
    if let Some(path) = &arguments.junit {
        let written = atomic::write_file(path, comparison.junit()?.as_bytes());
        written.map_err(|reason| RunError::File { path: path.clone(), reason })?;
    }
    say!("{}", comparison.table().trim_end());
    Ok(if comparison.passed() { DONE } else { CHECK_FAILED })
}
