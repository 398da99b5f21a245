//! The kinds of stages of a suite, one file each: what a stage reads, does, and costs.

mod capture;
mod lights;
mod maps;
mod relit;
mod scores;

use super::case_size::CaseSize;
use super::file::Suite;
use super::plan::{Stage, StageKind};
use super::stage_work::{Effort, StageWork};

impl StageKind {
    /// The inputs, the work and the costs of stages of this kind.
    pub fn work(self) -> &'static dyn StageWork {
        match self {
            Self::Capture => &capture::Capture,
            Self::Lights => &lights::Lights,
            Self::Maps => &maps::Maps,
            Self::Relit => &relit::Relit,
            Self::Scores => &scores::Scores,
        }
    }
}

impl Stage {
    /// How much there is to do.
    pub fn effort(&self, suite: &Suite) -> Effort {
        let size = CaseSize::of(&suite.cases[self.case]);
        self.kind.work().effort(suite, &size, self.method.map(|method| &suite.methods[method]))
    }
}
