//! Sizes of the maps, and values that are not finite.

use formats::picture::Picture;

use super::finding::Finding;
use super::folder::{COVERAGE, MapFolder};
use super::witness::Witness;

/// Pixels of the best view that one texel may span before the map wastes the capture.
const PIXELS_PER_TEXEL: f64 = 9.0;

/// Square, of one size, and large enough.
pub(super) fn sizes(maps: &MapFolder, witness: Option<&Witness>, findings: &mut Vec<Finding>) {
    let pictures = maps.pictures().map(|(file, map)| (file, map.width, map.height));
    let coverage = maps.coverage.iter().map(|map| (COVERAGE, map.width, map.height));
    let mut square = Vec::new();
    for (file, width, height) in pictures.chain(coverage) {
        if width != height {
            let message = format!("is {width}x{height}, not square");
            let fix = "write maps over the unit square of the UV chart";
            let evidence = [("width", width as f64), ("height", height as f64)];
            findings.push(Finding::error("not-square", file, message, fix).with(evidence));
        } else {
            square.push((file, width));
        }
    }
    // The size that most maps have; of as many, that of the first.
    let votes = |side: usize| square.iter().filter(|(_, other)| *other == side).count();
    let majority = square.iter().rev().max_by_key(|(_, side)| votes(*side));
    let Some(&(named, side)) = majority else { return };
    for (file, other) in square.iter().filter(|(_, other)| *other != side) {
        let message = format!("is {other}x{other}, but {named} is {side}x{side}");
        let fix = "write all maps in one size";
        let evidence = [("side", *other as f64), ("side_of_most", side as f64)];
        findings.push(Finding::error("sizes-differ", file, message, fix).with(evidence));
    }
    let Some(witness) = witness else { return };
    let texels = witness.chart_fraction() * (side * side) as f64;
    let pixels = witness.pixels as f64;
    if pixels > PIXELS_PER_TEXEL * texels && texels > 0.0 {
        let enough = (side as f64 * (pixels / texels).sqrt()).ceil() as usize;
        let enough = enough.next_power_of_two();
        let message = format!(
            "is {side}x{side}: the chart has {texels:.0} texels, but a training view shows it in \
             {pixels:.0} pixels"
        );
        let fix = format!("write maps of {enough}x{enough}");
        let evidence = [("texels", texels), ("pixels", pixels)];
        findings.push(Finding::warning("small", named, message, &fix).with(evidence));
    }
}

/// NaN and infinities in covered texels.
pub(super) fn finite(file: &str, map: &Picture, covered: &[bool], findings: &mut Vec<Finding>) {
    let wrong = |values: &[f32]| values.iter().any(|value| !value.is_finite());
    let texels = map.data.chunks_exact(map.channels).zip(covered).enumerate();
    let mut faulty = texels.filter(|(_, (values, covered))| **covered && wrong(values));
    let Some((first, _)) = faulty.next() else { return };
    let count = 1 + faulty.count();
    let (x, y) = (first % map.width, first / map.width);
    let message =
        format!("is NaN or infinite in {count} covered texels, the first at column {x}, row {y}");
    let fix = "write numbers there, or 0 into coverage.png where the map has no data";
    findings
        .push(Finding::error("not-finite", file, message, fix).with([("texels", count as f64)]));
}
