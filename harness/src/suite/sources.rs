//! Hashes of the code that makes results: a finished stage of a run stays valid until they change.

/// Hash of the solver's sources when this program was built.
pub const SOLVER_SOURCES: &str = env!("UNSHADE_SOLVER_SOURCES");
/// Hash of the sources that read pictures and meshes, for the renderer too.
pub const READER_SOURCES: &str = env!("UNSHADE_READER_SOURCES");
/// Hash of the scoring's sources.
pub(super) const SCORE_SOURCES: &str = env!("UNSHADE_SCORE_SOURCES");
