//! Hashes of the code that makes results, without its comments, documentation and tests: a finished stage of a run stays
//! valid until they change.

/// Hash of the code that reads pictures and meshes, for the renderer too.
pub const READER_SOURCES: &str = env!("UNSHADE_READER_SOURCES");
/// Hash of that and of the code that reads captures.
pub const CAPTURE_SOURCES: &str = env!("UNSHADE_CAPTURE_SOURCES");
/// Hash of that and of the solver's.
pub const SOLVER_SOURCES: &str = env!("UNSHADE_SOLVER_SOURCES");
/// Hash of the scoring's code, and of what it reads captures and files with.
pub const SCORE_SOURCES: &str = env!("UNSHADE_SCORE_SOURCES");

/// Code that keys of results hold.
#[derive(Clone, Copy)]
pub(super) struct Sources {
    pub capture: &'static str,
    pub solver: &'static str,
    pub scores: &'static str,
}

impl Sources {
    /// The code of this program.
    pub const BUILT: Self =
        Self { capture: CAPTURE_SOURCES, solver: SOLVER_SOURCES, scores: SCORE_SOURCES };
}
