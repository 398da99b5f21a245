//! The time that a solve still takes.
//!
//! The steps of different stages differ in cost. The plan states the cost of each on one machine; the speed of this
//! machine is measured while the solve runs, and the rest of the stage at work follows that stage's own pace.

use std::time::Instant;

/// Seconds that the machine's speed is trusted before anything is measured.
const PRIOR: f64 = 0.2;
/// Steps after which a stage goes by its own pace.
const SETTLED: usize = 5;

/// How much there is to solve, as far as the cost of a step depends on it.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Training views.
    pub views: usize,
    /// Their pixels that show the mesh.
    pub pixels: usize,
    /// Side of the textures that are solved for, texels.
    pub texture_size: usize,
}

/// The cost of a part of the solve on the machine where it was measured.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// Seconds before its first step.
    pub preparation: f64,
    /// Seconds per step.
    pub step: f64,
    pub steps: usize,
}

impl Work {
    /// All of it.
    pub fn seconds(&self) -> f64 {
        self.preparation + self.step * self.steps as f64
    }
}

/// Estimates the time that a solve still takes.
pub(super) struct Clock {
    parts: Vec<Work>,
    /// The part at work.
    at: usize,
    /// Its steps that are done, and how many of these this process did.
    done: usize,
    own: usize,
    /// The cost of all before it, as far as this process did them.
    expected: f64,
    start: Instant,
    /// When the first step of the part at work was done.
    first: Instant,
}

impl Clock {
    pub fn new(parts: Vec<Work>) -> Self {
        let now = Instant::now();
        Self { parts, at: 0, done: 0, own: 0, expected: 0.0, start: now, first: now }
    }

    /// Skips a stage that another process did.
    pub fn skip(&mut self) {
        self.at += 1;
    }

    /// Skips steps of the stage at work that another process did.
    pub fn skip_steps(&mut self, steps: usize) {
        self.done += steps;
    }

    /// Ends a stage.
    pub fn next(&mut self) {
        self.expected += self.part().preparation + self.part().step * self.own as f64;
        self.at += 1;
        (self.done, self.own) = (0, 0);
    }

    /// Counts a step, and returns the seconds that are left.
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
                let said = clock.tick_at(now);
                // A few seconds show the machine's pace, a few steps a stage's.
                if whole - left > 3.0 && step > SETTLED {
                    let off = (said - left).abs();
                    assert!(off < 0.25 * left + 0.5, "{said} s instead of {left} s");
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
        let mut said = 0.0;
        for _ in 0..10 {
            now += Duration::from_secs(1);
            said = clock.tick_at(now);
        }
        assert!((said - 150.0).abs() < 1.0, "{said}");
    }
}
