//! Progress on a terminal: one bar for the run, one for the stage; without a terminal, a line a
//! stage.

use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{HumanDuration, MultiProgress, ProgressBar, ProgressStyle};

use crate::suite::{Observer, TIME_LEFT};

/// Bars where standard error is a terminal, lines where it is not.
pub(super) struct Progress {
    bars: Option<Bars>,
}

struct Bars {
    run: ProgressBar,
    stage: ProgressBar,
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
            let stage = all.add(ProgressBar::new(0));
            stage.set_style(style("{bar:30} {percent:>3}% {prefix}: {msg}"));
            run.enable_steady_tick(Duration::from_millis(500));
            Bars { run, stage }
        });
        Self { bars }
    }

    /// Takes the bars away, so that what is printed next stands alone.
    pub(super) fn finish(&self) {
        if let Some(bars) = &self.bars {
            bars.stage.finish_and_clear();
            bars.run.finish_and_clear();
        }
    }
}

impl Observer for Progress {
    fn stage_begins(&mut self, id: &str, done: usize, total: usize) {
        if let Some(bars) = &self.bars {
            bars.run.set_length(total as u64);
            bars.run.set_position(done as u64);
            bars.stage.reset();
            bars.stage.set_length(0);
            bars.stage.set_prefix(id.to_owned());
            bars.stage.set_message("");
        }
    }

    fn step(&mut self, done: u64, total: u64, what: &str) {
        if let Some(bars) = &self.bars {
            bars.stage.set_length(total);
            bars.stage.set_position(done);
            // A bar's own estimate takes all steps for equal.
            bars.stage.set_message(match what.ends_with(TIME_LEFT) {
                true => what.to_owned(),
                false => format!("{what}, {}{TIME_LEFT}", HumanDuration(bars.stage.eta())),
            });
        }
    }

    fn stage_ends(&mut self, id: &str, seconds: Option<f64>) {
        let line = match seconds {
            Some(seconds) => format!("{id}: {seconds:.1} s"),
            None => format!("{id}: still valid"),
        };
        match &self.bars {
            Some(bars) => bars.run.println(line),
            None => eprintln!("{line}"),
        }
    }
}
