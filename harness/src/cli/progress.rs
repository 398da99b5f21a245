//! Progress on a terminal: one bar for the run, one for each stage; without a terminal, lines.

use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, MultiProgress, ProgressBar, ProgressStyle};

use crate::suite::{Observer, TIME_LEFT};

/// Between two lines on a stage that takes long.
const PAUSE: Duration = Duration::from_secs(30);
const TICK: Duration = Duration::from_millis(500);

impl Drop for Progress {
    fn drop(&mut self) {
        self.finish();
    }
}

/// Bars where standard error is a terminal, lines where it is not.
#[derive(Default)]
pub(super) struct Progress {
    /// On a terminal, from the first stage on.
    bars: Option<Bars>,
    /// When each running stage began, and when its last line was printed; without a terminal.
    begun: BTreeMap<String, (Instant, Instant)>,
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
    fn bars(&mut self) -> Option<&mut Bars> {
        if self.bars.is_none() && std::io::stderr().is_terminal() {
            let all = MultiProgress::new();
            let run = all.add(ProgressBar::new(0));
            // Without a length a bar shows as full.
            run.set_style(style("{spinner} begins  {elapsed}"));
            run.enable_steady_tick(TICK);
            self.bars = Some(Bars { all, run, stages: BTreeMap::new() });
        }
        self.bars.as_mut()
    }

    /// Takes the bars away, so that what is printed next stands alone.
    pub(super) fn finish(&self) {
        if let Some(bars) = &self.bars {
            bars.stages.values().for_each(ProgressBar::finish_and_clear);
            bars.run.finish_and_clear();
        }
    }

    /// Takes away the bar of a stage, and prints a line.
    fn line(&mut self, id: &str, line: String) {
        self.begun.remove(id);
        match &mut self.bars {
            Some(bars) => {
                bars.stages.remove(id).iter().for_each(ProgressBar::finish_and_clear);
                bars.run.println(line);
            }
            None => eprintln!("{line}"),
        }
    }
}

impl Observer for Progress {
    fn suite_begins(&mut self) {
        self.bars();
    }

    fn message(&mut self, line: &str) {
        match &self.bars {
            Some(bars) => bars.run.println(line),
            None => eprintln!("{line}"),
        }
    }

    fn stage_begins(&mut self, id: &str, done: usize, total: usize) {
        let Some(bars) = self.bars() else {
            self.begun.insert(id.to_owned(), (Instant::now(), Instant::now()));
            return;
        };
        bars.run.set_style(style("{bar:30} {pos}/{len} stages  {elapsed}"));
        bars.run.set_length(total as u64);
        bars.run.set_position(done as u64);
        let stage = bars.all.add(ProgressBar::new(0));
        stage.set_style(style("{spinner} {prefix}  {elapsed}  {wide_msg}"));
        stage.set_prefix(id.to_owned());
        stage.enable_steady_tick(TICK);
        bars.stages.insert(id.to_owned(), stage);
    }

    fn step(&mut self, id: &str, done: u64, total: u64, what: &str) {
        if let Some((begun, said)) =
            self.begun.get_mut(id).filter(|(_, said)| said.elapsed() >= PAUSE)
        {
            *said = Instant::now();
            let count = if total > 0 { format!("{done} of {total}, ") } else { String::new() };
            eprintln!("{id}: {:.0} s so far: {count}{what}", begun.elapsed().as_secs_f64());
        }
        let Some(stage) = self.bars.as_ref().and_then(|bars| bars.stages.get(id)) else { return };
        if total == 0 {
            stage.set_message(what.to_owned());
            return;
        }
        if stage.length() == Some(0) {
            stage.set_style(style("{bar:30} {percent:>3}% {prefix}  {elapsed}  {wide_msg}"));
        }
        stage.set_length(total);
        stage.set_position(done);
        // A bar's own estimate takes all steps for equal.
        stage.set_message(match what.ends_with(TIME_LEFT) {
            true => what.to_owned(),
            false => format!("{what}, {}{TIME_LEFT}", HumanDuration(stage.eta())),
        });
    }

    fn stage_ends(&mut self, id: &str, seconds: Option<f64>) {
        self.line(
            id,
            match seconds {
                Some(seconds) => format!("{id}: {seconds:.1} s"),
                None => format!("{id}: still valid"),
            },
        );
    }

    fn stage_fails(&mut self, id: &str, reason: &str) {
        self.line(id, format!("{id}: failed: {reason}"));
    }
}
