//! The interface of a kind of stage.

use std::path::Path;

use super::case_size::CaseSize;
use super::error::RunError;
use super::executor::StageExecutor;
use super::file::Suite;
use super::key::{Inputs, Key};
use super::method::Method;
use super::plan::Stage;
use super::program::Usage;

/// Called with how many of how many steps are done, and what is being done.
pub(super) type Step<'a> = &'a mut dyn FnMut(u64, u64, &str);

/// A process with the renderer in it, at the least (measured: 495 MB for 96 x 96 pictures), bytes.
pub(super) const RENDERER: u64 = 500 << 20;
/// Memory of scoring, and of methods that optimise nothing, bytes.
pub(super) const SMALL: u64 = 200 << 20;
/// A camera ray in flight, bytes, and how many there are at most, see `synth/unshade/render/passes.py`.
const RAY: u64 = 300;
const MAX_RAYS: u64 = 1 << 21;

/// Amount of work in a stage.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Effort {
    /// Seconds on two cores that a stage of this kind takes anyway.
    pub fixed: f64,
    /// Seconds on two cores per unit of `work`.
    pub rate: f64,
    /// Millions of rays of a stage that renders, of pixels of one that scores or projects; of a solve, seconds on two
    /// cores.
    pub work: f64,
    /// Bytes of the output as bare numbers.
    pub raw: f64,
    /// Name of the stages whose costs can be compared.
    pub class: String,
}

/// A kind of stage.
pub(super) trait StageWork: Sync {
    /// Key of what a stage reads, and of nothing else.
    fn key(&self, inputs: &Inputs) -> Result<Key, RunError>;

    /// Makes the output of a stage at `out`; returns the time and memory of a program.
    fn make(
        &self,
        executor: &StageExecutor,
        stage: &Stage,
        out: &Path,
        step: Step,
    ) -> Result<Option<Usage>, RunError>;

    /// How much there is to do for a case of this size.
    fn effort(&self, suite: &Suite, size: &CaseSize, method: Option<&Method>) -> Effort;

    /// Bytes of memory at the peak.
    fn memory(&self, executor: &StageExecutor, stage: &Stage) -> u64;
}

/// Bytes of a renderer that has the rays of a whole picture in flight, as far as it has so many.
pub(super) fn rendering_memory(size: &CaseSize) -> u64 {
    RENDERER + RAY * ((size.frame() * size.samples) as u64).min(MAX_RAYS)
}

/// Lights that the maps of a method are relit in.
pub(super) fn lights_of(size: &CaseSize, method: Option<&Method>) -> f64 {
    // The light of photographs is unknown.
    let own = !size.photographed || method.is_none_or(|method| method.work().recovers_light());
    f64::from(u8::from(own)) + size.other_lights
}

/// The number of scale modes in which maps are relit; 1 for photographs, which have no truth to fit a scale to.
fn scales_of(suite: &Suite, size: &CaseSize) -> f64 {
    if size.photographed { 1.0 } else { suite.scales.len() as f64 }
}

/// Pixels of all relit pictures of a method.
pub(super) fn relit_pixels(suite: &Suite, size: &CaseSize, method: Option<&Method>) -> f64 {
    size.test * lights_of(size, method) * scales_of(suite, size)
}
