//! The kinds of methods, one file each: how a method is found, made, keyed, and what it costs.

mod baseline;
mod competitor;
mod privileged;
mod program;
mod solver;

use scoring::run::Kind;

use super::method::{Method, MethodKind};
use super::method_work::{Fault, MethodWork};
use super::seeds::Vary;
use privileged::FromTruth;

impl MethodKind {
    /// The properties and the work of methods of this kind.
    pub(super) fn work(&self) -> &dyn MethodWork {
        match self {
            Self::Solver(solver) => solver,
            Self::Program(program) => &**program,
            Self::Oracle => &FromTruth::Oracle,
            Self::LabelMeans => &FromTruth::LabelMeans,
            Self::Competitor(competitor) => competitor,
            Self::Baseline(baseline) => baseline,
        }
    }

    /// Adds to every seed that the method states, or varies the last digits of what it reads.
    pub(super) fn reseed(&mut self, add: i64, vary: Vary) -> Result<(), Fault> {
        match self {
            Self::Solver(solver) => solver.reseed(add, vary),
            Self::Program(program) if vary != Vary::Rounding => {
                program.reseed(add);
                Ok(())
            }
            Self::Competitor(competitor) if vary != Vary::Rounding => competitor.reseed(add),
            _ => Ok(()),
        }
    }
}

impl Method {
    /// The part that it plays in results.
    pub fn role(&self) -> Kind {
        self.work().role()
    }

    /// The properties and the work of the method.
    pub(super) fn work(&self) -> &dyn MethodWork {
        self.kind.work()
    }
}
