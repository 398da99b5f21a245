//! What code made a result: a finished stage of a run stays valid until it changes.

/// What the solver's code was when this program was built.
pub const SOLVER_SOURCES: &str = env!("UNSHADE_SOLVER_SOURCES");
/// What the code was that reads pictures and meshes, for the renderer too.
pub const READER_SOURCES: &str = env!("UNSHADE_READER_SOURCES");
/// What the scoring's code was.
pub(super) const SCORE_SOURCES: &str = env!("UNSHADE_SCORE_SOURCES");
