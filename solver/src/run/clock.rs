//! The remaining time of a solve.
//!
//! The plan states the cost of each stage's steps on one machine. The speed of this machine relative to it is measured
//! during the solve; the rest of the current stage is estimated by that stage's own pace.

use std::time::Instant;

/// Weight of the prior that this machine is as fast as that of the plan, seconds.
const PRIOR: f64 = 0.2;
/// Steps after which a stage's own pace is used.
const SETTLED: usize = 5;

/// The size of a solve, on which the cost of a step depends.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Training views.
    pub views: usize,
    /// Their pixels that show the mesh.
    pub pixels: usize,
    /// Side of the textures that are solved for, texels.
    pub texture_size: usize,
    /// Whether the frames have several lights, or one that moves.
    pub has_changing_light: bool,
}

/// The cost of a stage on the machine where it was measured.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// Seconds before its first step.
    pub preparation: f64,
    /// Seconds per step.
    pub step: f64,
    pub steps: usize,
}

impl Work {
    /// Seconds of the whole stage.
    pub fn seconds(&self) -> f64 {
        self.preparation + self.step * self.steps as f64
    }
}

/// Estimates the remaining time of a solve.
pub(super) struct Clock {
    parts: Vec<Work>,
    /// The current stage.
    at: usize,
    /// The finished steps of the current stage, and how many of these this process took.
    done: usize,
    own: usize,
    /// The cost of the earlier stages, as far as this process ran them.
    expected: f64,
    start: Instant,
    /// The time of the first step of the current stage.
    first: Instant,
}

impl Clock {
    pub fn new(parts: Vec<Work>) -> Self {
        let now = Instant::now();
        Self { parts, at: 0, done: 0, own: 0, expected: 0.0, start: now, first: now }
    }

    /// Skips a stage whose value is stored.
    pub fn skip(&mut self) {
        self.at += 1;
    }

    /// Skips steps of the current stage that another process took.
    pub fn skip_steps(&mut self, steps: usize) {
        self.done += steps;
    }

    /// Ends a stage.
    pub fn next(&mut self) {
        self.expected += self.part().preparation + self.part().step * self.own as f64;
        self.at += 1;
        (self.done, self.own) = (0, 0);
    }

    /// Counts a step, and returns the remaining seconds.
    pub fn tick(&mut self) -> f64 {
        self.tick_at(Instant::now())
    }

    fn tick_at(&mut self, now: Instant) -> f64 {
        self.done += 1;
        self.own += 1;
        if self.own == 1 {
            self.first = now;
        }
        let part = self.part();
        let expected = self.expected + part.preparation + part.step * self.own as f64;
        let pace = (now.duration_since(self.start).as_secs_f64() + PRIOR) / (expected + PRIOR);
        let step = match self.own {
            own if own > SETTLED => now.duration_since(self.first).as_secs_f64() / (own - 1) as f64,
            _ => pace * part.step,
        };
        let later: f64 = self.parts.iter().skip(self.at + 1).map(Work::seconds).sum();
        step * part.steps.saturating_sub(self.done) as f64 + pace * later
    }

    fn part(&self) -> Work {
        self.parts.get(self.at).copied().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    /// On a machine three times as slow as expected, with stages that differ a hundredfold.
    #[test]
    fn time_left_is_right_although_stages_differ() {
        let part = |step, steps| Work { preparation: 0.0, step, steps };
        let mut clock = Clock::new(vec![part(0.01, 1000), part(1.0, 50), part(0.1, 100)]);
        let mut now = clock.start;
        let whole = 3.0 * (10.0 + 50.0 + 10.0);
        let mut left = whole;
        for (seconds, steps) in [(0.03, 1000), (3.0, 50), (0.3, 100)] {
            for step in 0..steps {
                now += Duration::from_secs_f64(seconds);
                left -= seconds;
                let estimate = clock.tick_at(now);
                // The machine's pace is known after a few seconds, a stage's after a few steps.
                if whole - left > 3.0 && step > SETTLED {
                    let off = (estimate - left).abs();
                    assert!(off < 0.25 * left + 0.5, "{estimate} s instead of {left} s");
                }
            }
            clock.next();
        }
    }

    #[test]
    fn steps_of_another_process_do_not_count_as_fast() {
        let part = Work { preparation: 0.0, step: 1.0, steps: 100 };
        let mut clock = Clock::new(vec![part; 3]);
        clock.skip();
        clock.skip_steps(40);
        let mut now = clock.start;
        let mut estimate = 0.0;
        for _ in 0..10 {
            now += Duration::from_secs(1);
            estimate = clock.tick_at(now);
        }
        assert!((estimate - 150.0).abs() < 1.0, "{estimate}");
    }
}
