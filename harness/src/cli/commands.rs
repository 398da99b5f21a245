//! The verbs of the command line.

use std::path::{Path, PathBuf};

use formats::atomic;
use scoring::score;
use scoring::study::{self, Study};
use solver::Choice;

use super::alone::{alone, tools};
use super::arguments::{BackendName, RendererName, SolveArgs, SolverName, SynthArgs, Verb};
use super::exit::DONE;
use super::run::run_suite;
use super::{bench, calibrate, check, clean, compare, doctor, export, figure, seal, start};
use crate::rerun_viewer::{RerunViewer, ViewerError};
use crate::suite::{self, BaselineMethod, Budget, OwnMetrics, Relight, RunError};

pub(super) fn run(verb: Verb) -> Result<u8, RunError> {
    match verb {
        Verb::Synth(arguments) => synth(arguments)?,
        Verb::Solve(arguments) => solve(&arguments)?,
        Verb::Relight { capture, maps, out, renderer, light } => {
            let renderer = match renderer {
                RendererName::Mitsuba => "mitsuba",
                RendererName::Cycles => "cycles",
            };
            let relight = Relight {
                capture: &capture,
                maps: &maps,
                out: &out,
                renderer,
                scales: &suite::SCALES,
                light: light.as_deref(),
            };
            alone("relight", |tools, step| suite::relight(&relight, tools, step))?;
        }
        Verb::Budget { capture, maps, out, light, view } => {
            let (light, view) = (light.as_deref(), view.as_deref());
            let budget = Budget { capture: &capture, maps: &maps, out: &out, light, view };
            alone("budget", |tools, step| suite::budget(&budget, tools, step).map(|_| ()))?;
            say!("{}", out.join("budget.md").display());
        }
        Verb::Export(arguments) => export::export(&arguments)?,
        Verb::Check { submission: Some(folder), captures, .. } => {
            return check::submission(&folder, captures.as_deref());
        }
        Verb::Check { maps, capture, .. } => {
            return Ok(check::check(&maps.unwrap_or_default(), capture.as_deref())?);
        }
        Verb::Seal(arguments) => return seal::seal(&arguments),
        Verb::Verify { folder, key } => seal::verify(&folder, key.as_deref())?,
        Verb::Score { capture, maps, relit, lpips, metric, out } => {
            let inputs = [Some(&*capture), Some(&*maps), relit.as_deref()];
            atomic::refuse_overlap(&out, &inputs.into_iter().flatten().collect::<Vec<_>>())?;
            let mut scores = score::score(&capture, &maps, relit.as_deref())?;
            if let Some(net) = lpips {
                let rows = suite::lpips(&net, &capture, &maps, relit.as_deref(), &tools())?;
                scores.rows.extend(rows);
            }
            let own = OwnMetrics::new(metric, PathBuf::new());
            own.add_rows(&mut scores, [&capture, &maps], relit.as_deref(), &tools())?;
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
        Verb::Run(arguments) => return run_suite(arguments),
        Verb::Clean { run, keep, earlier_gb, earlier_days } => {
            let bytes = earlier_gb.map(|gb| (gb * 1e9) as u64);
            let seconds = earlier_days.map(|days| days * 86_400.0);
            clean::clean(&run, &keep, suite::Bound { bytes, seconds })?;
        }
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
        Verb::Compare(arguments) => return compare::compare(&arguments),
        Verb::Calibrate(arguments) => return calibrate::calibrate(&arguments),
        Verb::Study { runs, out } => study(&runs, out.as_deref())?,
        Verb::Site { runs, out } => {
            say!("{}", report::write_site(&runs, &out)?.index.display());
        }
        Verb::Bench(arguments) => bench::bench(&arguments)?,
        Verb::Doctor { physics } => return doctor::examine(&tools(), physics),
    }
    Ok(DONE)
}

fn study(runs: &[PathBuf], out: Option<&Path>) -> Result<(), RunError> {
    let mut words = vec!["unshade study".to_owned()];
    words.extend(runs.iter().map(|run| run.display().to_string()));
    words.extend(out.map(|out| format!("-o {}", out.display())));
    let command = words.join(" ");
    let observations = study::observations(runs)?;
    let found = Study::of(&observations);
    match out {
        Some(out) => {
            study::write_study(&found, &observations, runs, out, &command)?;
            say!("{}", out.join("study.md").display());
        }
        None => say!("{}", found.markdown(&command).trim_end()),
    }
    Ok(())
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
    let mut config = suite::solver_config(&arguments.config)?;
    if arguments.no_records {
        config = config.without_records();
    }
    if arguments.rerun.is_some() && arguments.solver != SolverName::Fields {
        let reason = "a baseline has no steps to show; remove --rerun".to_owned();
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
