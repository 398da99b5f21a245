//! The first look at a capture: whether the mesh is where the cameras look. Its silhouette is
//! compared with the masks before anything is solved.

mod silhouette;
mod trials;

use std::path::Path;

use glam::Mat4;

use crate::{CaptureError, Mesh, View};
use silhouette::{Comparison, REFUSED, compare, median};
use trials::spread;

/// Median overlap below which a warning is due.
const DOUBTFUL: f64 = 0.9;
/// Intersection over union that a single change must reach to be named; from [`DOUBTFUL`] on, it
/// proves that the cameras are wrong.
const FITS: f64 = 0.8;
/// Views at which silhouettes are compared, spread over all.
const MAX_VIEWS: usize = 24;
/// Triangles painted in all, which bounds the time.
const MAX_TRIANGLES: usize = 4_000_000;

/// Warns of a mesh that hardly fits its masks, and refuses one that does not, saying what would
/// fit. `applied` is how the writer of the file moved all cameras.
pub(crate) fn check(
    folder: &Path,
    mesh: &Mesh,
    views: &[View],
    applied: Option<Mat4>,
) -> Result<(), CaptureError> {
    let views = chosen(mesh, views);
    let compared: Vec<Comparison> =
        views.iter().filter_map(|view| compare(mesh, &view.camera, &view.mask)).collect();
    if compared.is_empty() {
        return Ok(());
    }
    let overlap = median(compared.iter().map(Comparison::overlap).collect());
    let fit = |found: &Comparison| if found.unmasked { found.overlap() } else { found.union() };
    let union = median(compared.iter().map(fit).collect());
    if overlap >= DOUBTFUL && union >= REFUSED {
        return Ok(());
    }
    let found = trials::best(mesh, &views, applied).filter(|trial| trial.union >= FITS);
    let fix = match &found {
        Some(trial) => format!("{} ({:.2} of it then)", trial.fix, trial.union),
        None => "no single change fixes it: check transform_matrix (camera to world, looking down \
                 -z), fl_x to cy (pixels), the mesh's units and the masks"
            .to_owned(),
    };
    let path = folder.join("transforms.json");
    let views = compared.len();
    if found.is_some_and(|trial| trial.union >= DOUBTFUL) {
        return Err(CaptureError::Misplaced { path, overlap: overlap.min(union), views, fix });
    }
    if overlap < REFUSED {
        return Err(CaptureError::Misplaced { path, overlap, views, fix });
    }
    if overlap < DOUBTFUL {
        tracing::warn!(
            "{}: the mesh covers {overlap:.2} of the masks (median of {views} views; .90 is \
             sound); {fix}",
            path.display()
        );
    }
    Ok(())
}

/// Views spread over all, as many as are looked at in a fraction of a second.
fn chosen<'a>(mesh: &Mesh, views: &'a [View]) -> Vec<&'a View> {
    let max_views = (MAX_TRIANGLES / mesh.triangles.len().max(1)).clamp(3, MAX_VIEWS);
    spread(&views.iter().collect::<Vec<_>>(), max_views)
}

#[cfg(test)]
mod tests;
