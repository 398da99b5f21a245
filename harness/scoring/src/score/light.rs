//! The light that a method found against the true one: its brightest directions, its radiance over
//! equal solid angles, and spheres that it lights.

use std::path::Path;

use formats::picture::{self, Picture};
use glam::DVec3;

use super::ScoreError;
use super::light_cells::{COLUMNS, CellLight, ROWS, RowsAt};
use super::light_spheres::{Surface, disc, sphere};
use super::rows::{Compared, Floors, Heading, rows};
use super::scores::Row;
use super::truth;
use crate::metrics::{Pair, Region, Scale, ScaleMode, scored};

/// Rows of `light.exr` of a maps folder; none without one. The truth's is that of the capture.
pub(super) fn rows_of_light(capture: &Path, maps: &Path) -> Result<Vec<Row>, ScoreError> {
    let (found, truth) = (maps.join("light.exr"), truth::folder(capture)?.join("light.exr"));
    if !found.is_file() || !truth.is_file() {
        return Ok(Vec::new());
    }
    let read = |path: &Path| picture::read_exr_colour(path, &["R", "G", "B"]);
    let found = CellLight::of(&read(&found)?, RowsAt::Bands);
    let truth = CellLight::of(&read(&truth)?, RowsAt::Poles);
    let mut all = Vec::new();

    let peaks = truth.peaks();
    let nearest: Vec<DVec3> = {
        let own = found.peaks();
        let near =
            |peak: &DVec3| own.iter().copied().max_by(|a, b| a.dot(*peak).total_cmp(&b.dot(*peak)));
        peaks.iter().map(|peak| near(peak).unwrap_or(DVec3::ZERO)).collect()
    };
    if !peaks.is_empty() {
        let whole = Region::whole(peaks.len(), 1).map_err(ScoreError::of("light_peaks"))?;
        let (p, g) = (row_of(&nearest), row_of(&peaks));
        let pair = Pair::new(&p, &g, &whole).map_err(ScoreError::of("light_peaks"))?;
        all.extend(light_rows("light_peaks", ScaleMode::None, &scored::PEAKS, pair)?);
    }

    // One factor for all: that of the diffuse spheres, since of lamps side by side no factor makes
    // one the other. A light that is black everywhere has none and is compared as it is.
    let sphere_region =
        Region::of_mask("sphere", &disc()).map_err(ScoreError::of("light_diffuse_sphere"))?;
    let [p, g] = [&found, &truth].map(|light| sphere(light, Surface::Diffuse));
    let factors = Pair::new(&p, &g, &sphere_region)
        .and_then(|pair| Scale::fit(&pair))
        .map_or([1.0; 3], |scale| scale.factors(ScaleMode::Global));
    let wrong = ScoreError::of("light");
    let whole = Region::whole(COLUMNS, ROWS).map_err(&wrong)?;
    let pair = Pair::new(&found.picture, &truth.picture, &whole).map_err(&wrong)?;
    all.extend(light_rows("light", ScaleMode::Global, &scored::LIGHT, pair.scaled(factors))?);
    for (subject, surface) in [
        ("light_mirror_sphere", Surface::Mirror),
        ("light_glossy_sphere", Surface::Glossy),
        ("light_diffuse_sphere", Surface::Diffuse),
    ] {
        let [p, g] = [&found, &truth].map(|light| sphere(light, surface));
        let pair = Pair::new(&p, &g, &sphere_region).map_err(ScoreError::of(subject))?;
        let metrics =
            if surface == Surface::Diffuse { &scored::SPHERE[..] } else { &scored::SPHERE[..2] };
        all.extend(light_rows(subject, ScaleMode::Global, metrics, pair.scaled(factors))?);
    }
    Ok(all)
}

fn light_rows(
    subject: &str,
    mode: ScaleMode,
    metrics: &[&str],
    pair: Pair,
) -> Result<Vec<Row>, ScoreError> {
    let heading = Heading { subject, light: None, scale: mode.id(), label: None };
    rows(heading, metrics, &[Compared { frame: None, pair }], &Floors::new())
}

/// Directions as a picture of one row.
fn row_of(directions: &[DVec3]) -> Picture {
    let data = directions.iter().flat_map(|d| d.as_vec3().to_array()).collect();
    Picture { width: directions.len(), height: 1, channels: 3, data }
}
