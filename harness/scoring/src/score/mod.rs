//! Scores: maps, withheld views, relit pictures and layers against the truth of a capture.

mod cast_shadow;
mod confidence;
mod error;
mod geometry;
mod label_means;
mod light;
mod light_cells;
mod light_spheres;
mod maps;
mod names;
mod noise_floor;
mod observability;
mod oracle;
mod own;
mod photographs;
mod pictures;
mod protocol;
mod render;
mod rows;
mod scores;
mod shown;
mod surface_scale;
mod truth;

use std::path::Path;

use formats::Maps;
use formats::content_hash::hash_path;

pub use crate::metrics::Scale;
pub use error::ScoreError;
pub use label_means::label_mean_maps;
pub use observability::Observability;
pub use oracle::oracle_maps;
pub use own::keep_own_relit;
pub use photographs::{FOUND_LIGHT, is_photographed};
pub use protocol::Protocol;
pub use scores::{Inputs, RegionSize, Row, Scores};
pub use shown::{Shown, judged_rows, shown, shown_maps, withheld_picture};

use crate::check::check;
use geometry::Geometry;
use names::{name_of, renderer_of, solver_name};
use pictures::Frame;
use truth::{Identity, Truth};

/// Scores a maps folder, and the pictures relit with it, against the capture's truth.
///
/// Missing maps, views and pictures have no rows; a folder with none of them is an error. Likely faults
/// of the maps, which show without the truth, are listed in `findings`. For a capture without truth,
/// pictures are compared with its withheld photographs.
pub fn score(capture: &Path, maps: &Path, relit: Option<&Path>) -> Result<Scores, ScoreError> {
    if is_photographed(capture) {
        return photographs::score(capture, maps, relit);
    }
    let truth = Truth::open(capture)?;
    let Identity { face, light, protocol } = Identity::read(capture)?;
    let renderer = relit.map(renderer_of).transpose()?.flatten();
    let protocol = protocol.relit_by(renderer.as_deref());
    let found = Maps::read(maps)?;
    let scale =
        found.diffuse_albedo.as_ref().map(|albedo| maps::fit(albedo, &truth)).transpose()?;
    let frames = Frame::withheld(capture, &light)?;
    let geometry = Geometry::of(capture, &truth)?;
    let findings = check(maps, Some(capture))?;
    let (of_maps, of_pictures) = rayon::join(
        || maps::rows_of_maps(&found, &truth, &geometry, scale.as_ref()),
        || -> Result<_, ScoreError> {
            let highlights = truth.highlights();
            let rows_of = |relit| pictures::relit_rows(&frames, capture, relit, highlights);
            let relit = relit.map(rows_of);
            let views = pictures::view_rows(&frames, capture, maps, &light, highlights)?;
            Ok((views, relit.transpose()?.unwrap_or_default()))
        },
    );
    let (views, relit_rows) = of_pictures?;
    if views.is_empty() && relit_rows.is_empty() && is_empty(&found) {
        return Err(ScoreError::Nothing(maps.to_path_buf()));
    }
    let mut rows = of_maps?;
    if let Some((albedo, scale)) = found.diffuse_albedo.as_ref().zip(scale.as_ref()) {
        rows.extend(confidence::rows_of_confidence(maps, albedo, &truth, scale)?);
    }
    rows.extend(light::rows_of_light(capture, maps)?);
    rows.extend(views);
    rows.extend(relit_rows);
    let hash = |path: &Path| hash_path(path).map_err(|error| ScoreError::io(path, error));
    let inputs =
        Inputs { capture: hash(capture)?, maps: hash(maps)?, relit: relit.map(hash).transpose()? };
    let of_maps = maps::region_size(&truth, found.coverage.as_ref());
    let mut regions = vec![RegionSize { texel_mm: Some(geometry.texel_mm), ..of_maps }];
    regions.extend(frames.iter().map(Frame::region_size));
    Ok(Scores {
        format: Scores::FORMAT,
        capture: name_of(capture),
        face,
        skin_tone: truth.skin_tone(),
        light,
        solver: solver_name(maps)?,
        protocol,
        inputs,
        scale,
        regions,
        findings,
        metrics: Vec::new(),
        rows,
    })
}

/// The factors that align the diffuse albedo of a maps folder with the truth.
pub fn fit_scale(capture: &Path, maps: &Path) -> Result<Scale, ScoreError> {
    let truth = Truth::open(capture)?;
    let albedo = Maps::read(maps)?.diffuse_albedo.ok_or_else(|| ScoreError::Missing {
        path: maps.join("diffuse_albedo.exr"),
        fix: "a face cannot be relit without it",
    })?;
    maps::fit(&albedo, &truth)
}

fn is_empty(maps: &Maps) -> bool {
    let Maps { diffuse_albedo, specular_albedo, diffuse_normal, specular_normal, .. } = maps;
    [diffuse_albedo, specular_albedo, diffuse_normal, specular_normal]
        .iter()
        .all(|map| map.is_none())
}
