//! Progress on a terminal: one bar for the run, one for the stage; without a terminal, a line a
//! stage.

use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{HumanDuration, MultiProgress, ProgressBar, ProgressStyle};

use crate::suite::{Observer, TIME_LEFT};

/// Bars where standard error is a terminal, lines where it is not.
pub(super) struct Progress {
    bars: Option<Bars>,
}

struct Bars {
    all: MultiProgress,
    run: ProgressBar,
    /// Bars of the stages that are being done, by the stages' ids.
    stages: BTreeMap<String, ProgressBar>,
}

fn style(template: &str) -> ProgressStyle {
    // The templates are constants of this file; the plain style is what indicatif falls back to.
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

impl Progress {
    pub(super) fn new() -> Self {
        let bars = std::io::stderr().is_terminal().then(|| {
            let all = MultiProgress::new();
            let run = all.add(ProgressBar::new(0));
            run.set_style(style("{bar:30} {pos}/{len} stages  {elapsed}"));
            run.enable_steady_tick(Duration::from_millis(500));
            Bars { all, run, stages: BTreeMap::new() }
        });
        Self { bars }
    }

    /// Takes the bars away, so that what is printed next stands alone.
    pub(super) fn finish(&self) {
        if let Some(bars) = &self.bars {
            bars.stages.values().for_each(ProgressBar::finish_and_clear);
            bars.run.finish_and_clear();
        }
    }
}

impl Observer for Progress {
    fn stage_begins(&mut self, id: &str, done: usize, total: usize) {
        if let Some(bars) = &mut self.bars {
            bars.run.set_length(total as u64);
            bars.run.set_position(done as u64);
            let stage = bars.all.add(ProgressBar::new(0));
            stage.set_style(style("{bar:30} {percent:>3}% {prefix}: {msg}"));
            stage.set_prefix(id.to_owned());
            bars.stages.insert(id.to_owned(), stage);
        }
    }

    fn step(&mut self, id: &str, done: u64, total: u64, what: &str) {
        if let Some(stage) = self.bars.as_ref().and_then(|bars| bars.stages.get(id)) {
            stage.set_length(total);
            stage.set_position(done);
            // A bar's own estimate takes all steps for equal.
            stage.set_message(match what.ends_with(TIME_LEFT) {
                true => what.to_owned(),
                false => format!("{what}, {}{TIME_LEFT}", HumanDuration(stage.eta())),
            });
        }
    }

    fn stage_ends(&mut self, id: &str, seconds: Option<f64>) {
        let line = match seconds {
            Some(seconds) => format!("{id}: {seconds:.1} s"),
            None => format!("{id}: still valid"),
        };
        match &mut self.bars {
            Some(bars) => {
                bars.stages.remove(id).iter().for_each(ProgressBar::finish_and_clear);
                bars.run.println(line);
            }
            None => eprintln!("{line}"),
        }
    }
}
