//! Maps against the truth.

use formats::Maps;
use formats::picture::{GrayImage, Picture};
use glam::Vec3;

use super::ScoreError;
use super::geometry::Geometry;
use super::rows::{Compared, Floors, Heading, rows};
use super::scores::{RegionSize, Row};
use super::surface_scale::Cells;
use super::truth::{LABELS, Truth, mean_alpha};
use crate::metrics::{Pair, Region, Scale, ScaleMode, black_outside, resample, scored};

/// Mean alpha of the lobes that skin is usually rendered with, .15 and .35 in equal parts (Digital Emily 2).
const USUAL_ALPHA: f32 = 0.25;

/// The rows of every map that `maps` has, and of the trivial answers.
pub(super) fn rows_of_maps(
    maps: &Maps,
    truth: &Truth,
    geometry: &Geometry,
    scale: Option<&Scale>,
) -> Result<Vec<Row>, ScoreError> {
    let mut all = Vec::new();
    if let Some((albedo, scale)) = maps.diffuse_albedo.as_ref().zip(scale) {
        all.extend(albedo_rows(&fit_to(albedo, truth), truth, geometry, scale)?);
    }
    if let Some(specular) = &maps.specular_albedo {
        let specular = fit_to(specular, truth);
        all.extend(map_rows(
            "specular_albedo",
            &scored::SPECULAR,
            &specular,
            &truth.specular_albedo,
            truth,
        )?);
    }
    let constant = constant(&truth.specular_albedo, &truth.region);
    all.extend(map_rows(
        "constant_specular_albedo",
        &scored::SPECULAR[..1],
        &constant,
        &truth.specular_albedo,
        truth,
    )?);
    if let Some(roughness) = &maps.roughness {
        let alpha = fit_to(&mean_alpha(roughness), truth);
        all.extend(map_rows("roughness", &scored::ROUGHNESS, &alpha, &truth.roughness, truth)?);
    }
    for (subject, alpha) in [
        ("usual_roughness", USUAL_ALPHA),
        ("constant_roughness", geometric_mean(&truth.roughness, &truth.region)),
    ] {
        let data = vec![alpha; truth.roughness.data.len()];
        let constant = Picture { data, ..truth.roughness.clone() };
        all.extend(map_rows(subject, &scored::ROUGHNESS, &constant, &truth.roughness, truth)?);
    }
    for (subject, trivial, map, true_normal) in normals(maps, truth) {
        if let Some(normal) = map {
            // Angles do not depend on length, so nothing is left to renormalise.
            let normal = fit_to(normal, truth);
            all.extend(map_rows(subject, &scored::NORMAL, &normal, true_normal, truth)?);
            let pair = Pair::new(&normal, true_normal, &truth.region)
                .and_then(|pair| pair.with_cause(&geometry.mesh_normal))
                .map_err(ScoreError::of(subject))?;
            let compared = [Compared { frame: None, pair }];
            let heading = heading(subject, ScaleMode::None);
            all.extend(rows(heading, &scored::RELIEF, &compared, &Floors::new())?);
            all.extend(by_area(subject, &normal, true_normal, truth, geometry)?);
        }
        let mesh = &geometry.mesh_normal;
        all.extend(map_rows(trivial, &scored::NORMAL, mesh, true_normal, truth)?);
        all.extend(by_area(trivial, mesh, true_normal, truth, geometry)?);
    }
    for cells in Cells::of_all_sides(geometry, &truth.region)? {
        all.extend(rows_of_cells(&cells, maps, truth, geometry, scale)?);
    }
    Ok(all)
}

/// The rows of maps averaged over cells of the surface, as the truth is.
fn rows_of_cells(
    cells: &Cells,
    maps: &Maps,
    truth: &Truth,
    geometry: &Geometry,
    scale: Option<&Scale>,
) -> Result<Vec<Row>, ScoreError> {
    let mut all = Vec::new();
    let of = |subject: &str, metrics: &[&str], mode: ScaleMode, map: &Picture, truth: &Picture| {
        let factors = scale.map_or([1.0; 3], |scale| scale.factors(mode));
        let pair = Pair::new(map, truth, &cells.region)
            .and_then(|pair| pair.scaled(factors).with_area(&geometry.texel_area))
            .map_err(ScoreError::of(subject))?;
        let compared = [Compared { frame: None, pair }];
        rows(heading(subject, mode), metrics, &compared, &Floors::new())
    };
    if let Some(albedo) = &maps.diffuse_albedo {
        let albedo = cells.averaged(&fit_to(albedo, truth));
        let true_albedo = cells.averaged(&truth.diffuse_albedo);
        for mode in [ScaleMode::None, ScaleMode::Global] {
            all.extend(of("diffuse_albedo", &scored::ALBEDO_AREA, mode, &albedo, &true_albedo)?);
        }
    }
    let true_specular = cells.averaged(&truth.specular_albedo);
    let constant = constant(&truth.specular_albedo, &truth.region);
    let none = ScaleMode::None;
    all.extend(of(
        "constant_specular_albedo",
        &scored::SPECULAR[..1],
        none,
        &constant,
        &true_specular,
    )?);
    if let Some(specular) = &maps.specular_albedo {
        let specular = cells.averaged(&fit_to(specular, truth));
        all.extend(of("specular_albedo", &scored::SPECULAR[..2], none, &specular, &true_specular)?);
    }
    let mesh = cells.averaged(&geometry.mesh_normal);
    for (subject, trivial, map, true_normal) in normals(maps, truth) {
        let true_normal = cells.averaged(true_normal);
        all.extend(of(trivial, &scored::NORMAL_AREA, none, &mesh, &true_normal)?);
        if let Some(map) = map {
            let map = cells.averaged(&unit(fit_to(map, truth)));
            all.extend(of(subject, &scored::NORMAL_AREA, none, &map, &true_normal)?);
        }
    }
    Ok(all)
}

/// Both normal maps: the names of the map and of the mesh in its place, the map, its truth.
fn normals<'a>(
    maps: &'a Maps,
    truth: &'a Truth,
) -> [(&'static str, &'static str, Option<&'a Picture>, &'a Picture); 2] {
    let (specular, diffuse) = (maps.specular_normal.as_ref(), maps.diffuse_normal.as_ref());
    [
        ("specular_normal", "mesh_specular_normal", specular, &truth.specular_normal),
        ("diffuse_normal", "mesh_diffuse_normal", diffuse, &truth.diffuse_normal),
    ]
}

/// Vectors of length 1; a vector without length stays.
fn unit(mut normals: Picture) -> Picture {
    for normal in normals.data.chunks_exact_mut(3) {
        let unit = Vec3::from_slice(normal).normalize_or_zero();
        normal.copy_from_slice(&unit.to_array());
    }
    normals
}

/// The factors that align the diffuse albedo with the truth.
pub(super) fn fit(albedo: &Picture, truth: &Truth) -> Result<Scale, ScoreError> {
    let albedo = fit_to(albedo, truth);
    Pair::new(&albedo, &truth.diffuse_albedo, &truth.region)
        .and_then(|pair| Scale::fit(&pair))
        .map_err(ScoreError::of("diffuse_albedo"))
}

/// The sizes of the map regions, and the parts of them that the solver claims.
pub(super) fn region_size(truth: &Truth, claimed: Option<&GrayImage>) -> RegionSize {
    let (width, height) = truth.region.size();
    let inside = truth.region.pixels();
    let solved = claimed.map(|claimed| {
        // The texel of the claim in which the truth's texel has its centre.
        let at = |i: usize, from: usize, to: usize| (2 * i + 1) * from / (2 * to);
        let is_claimed = |i: &&usize| {
            let (x, y) =
                (at(**i % width, claimed.width, width), at(**i / width, claimed.height, height));
            claimed.data[y * claimed.width + x] > 127
        };
        inside.iter().filter(is_claimed).count() as f64 / inside.len() as f64
    });
    RegionSize::new(&truth.region, truth.region.name(), &truth.coverage, solved)
}

fn albedo_rows(
    albedo: &Picture,
    truth: &Truth,
    geometry: &Geometry,
    scale: &Scale,
) -> Result<Vec<Row>, ScoreError> {
    let wrong = ScoreError::of("diffuse_albedo");
    let masked = black_outside(albedo, &truth.coverage);
    let true_masked = black_outside(&truth.diffuse_albedo, &truth.coverage);
    let parts = parts(truth);
    let pair = |region, mode| {
        let pair = Pair::new(&masked, &true_masked, region)?.scaled(scale.factors(mode));
        pair.with_labels(&truth.labels)
    };
    let mut all = Vec::new();
    let mut add = |metrics: &[&str], mode: ScaleMode, label, pair| {
        let heading = Heading { label, ..heading("diffuse_albedo", mode) };
        let compared = [Compared { frame: None, pair }];
        all.extend(rows(heading, metrics, &compared, &Floors::new())?);
        Ok::<_, ScoreError>(())
    };
    for mode in ScaleMode::ALL {
        let metrics =
            if mode == ScaleMode::Median { &scored::ALBEDO[..5] } else { &scored::ALBEDO };
        add(metrics, mode, None, pair(&truth.region, mode).map_err(&wrong)?)?;
    }
    add(
        &scored::ALBEDO_UNSCALED,
        ScaleMode::None,
        None,
        pair(&truth.region, ScaleMode::None).map_err(&wrong)?,
    )?;
    let whole = Region::of_mask("coverage", &truth.coverage).map_err(&wrong)?;
    for (metrics, region) in
        [(&scored::COMPATIBLE_ALBEDO, &truth.region), (&scored::COMPATIBLE_ALBEDO_WHOLE, &whole)]
    {
        add(metrics, ScaleMode::None, None, pair(region, ScaleMode::None).map_err(&wrong)?)?;
    }
    for (metric, cause) in scored::LEAKAGE.iter().zip([&geometry.shading, &geometry.specular]) {
        let aligned = pair(&truth.region, ScaleMode::Global);
        let pair = aligned.and_then(|pair| pair.with_cause(cause)).map_err(&wrong)?;
        add(&[*metric], ScaleMode::Global, None, pair)?;
    }
    for mode in [ScaleMode::None, ScaleMode::Global] {
        let pair = pair(&truth.region, mode)
            .and_then(|pair| pair.with_area(&geometry.texel_area))
            .map_err(&wrong)?;
        add(&scored::ALBEDO_AREA, mode, None, pair)?;
    }
    for (label, region) in &parts {
        for mode in [ScaleMode::None, ScaleMode::Global] {
            let metrics: &[&str] =
                if *label == Some("skin") { &scored::PART } else { &scored::PART[..2] };
            add(metrics, mode, *label, pair(region, mode).map_err(&wrong)?)?;
        }
        if *label == Some("skin") {
            let pair = pair(region, ScaleMode::None).map_err(&wrong)?;
            add(&scored::DETAIL, ScaleMode::None, *label, pair)?;
        }
    }
    Ok(all)
}

/// The labels that the covered face shows, and what more than one view sees.
fn parts(truth: &Truth) -> Vec<(Option<&'static str>, Region)> {
    let of_label = |(id, name): &(u8, &'static str)| {
        let part = truth.region.part(truth.region.name(), |i| truth.labels.data[i] == *id);
        Some((Some(*name), part.ok()?))
    };
    let twice = truth.region.part("coverage-e5-views2", |i| truth.views.data[i] >= 2);
    LABELS.iter().filter_map(of_label).chain(twice.ok().map(|part| (None, part))).collect()
}

fn map_rows(
    subject: &str,
    metrics: &[&str],
    map: &Picture,
    true_map: &Picture,
    truth: &Truth,
) -> Result<Vec<Row>, ScoreError> {
    let pair = Pair::new(map, true_map, &truth.region).map_err(ScoreError::of(subject))?;
    let compared = [Compared { frame: None, pair }];
    rows(heading(subject, ScaleMode::None), metrics, &compared, &Floors::new())
}

/// Rows of a normal map whose texels count by their area.
fn by_area(
    subject: &str,
    normal: &Picture,
    true_normal: &Picture,
    truth: &Truth,
    geometry: &Geometry,
) -> Result<Vec<Row>, ScoreError> {
    let pair = Pair::new(normal, true_normal, &truth.region)
        .and_then(|pair| pair.with_area(&geometry.texel_area))
        .map_err(ScoreError::of(subject))?;
    let compared = [Compared { frame: None, pair }];
    rows(heading(subject, ScaleMode::None), &scored::NORMAL_AREA, &compared, &Floors::new())
}

fn heading(subject: &str, mode: ScaleMode) -> Heading<'_> {
    Heading { subject, light: None, scale: mode.id(), label: None }
}

fn fit_to(map: &Picture, truth: &Truth) -> Picture {
    let (width, height) = truth.region.size();
    resample(map, width, height)
}

/// The constant map with the smallest squared error: the mean of the truth.
fn constant(map: &Picture, region: &Region) -> Picture {
    let sum: f64 = region.pixels().iter().map(|i| f64::from(map.data[*i])).sum();
    let mean = (sum / region.pixels().len() as f64) as f32;
    Picture { data: vec![mean; map.data.len()], ..map.clone() }
}

/// The constant with the smallest squared log ratio.
fn geometric_mean(map: &Picture, region: &Region) -> f32 {
    let logs = region.pixels().iter().map(|i| f64::from(map.data[*i]).max(1e-3).ln());
    (logs.sum::<f64>() / region.pixels().len() as f64).exp() as f32
}
