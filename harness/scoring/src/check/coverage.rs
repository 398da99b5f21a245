//! The coverage: 255 where the maps have data, else 0.

use formats::picture::{GrayImage, Picture};

use super::finding::Finding;
use super::folder::COVERAGE;
use super::orientation::{of_coverage, overlap};
use super::reduced::{Reduced, SIDE};
use super::witness::Witness;

/// From here on a texel is covered, as in the scores.
const COVERED: u8 = 128;
/// Fraction of the texels between 0 and 255 that soft edges explain.
const SOFT_FRACTION: f64 = 0.02;
/// Fraction of the seen chart that a coverage should hold.
const MIN_FRACTION: f64 = 0.6;

/// The faults of a coverage.
pub(super) fn check(map: &GrayImage, witness: Option<&Witness>, findings: &mut Vec<Finding>) {
    let total = map.data.len().max(1) as f64;
    let count = |keep: fn(u8) -> bool| map.data.iter().filter(|value| keep(**value)).count();
    let largest = map.data.iter().copied().max().unwrap_or(0);
    if largest < COVERED {
        let evidence = [("maximum", f64::from(largest))];
        let (message, fix) = if largest == 0 {
            ("covers nothing: all of it is 0".to_owned(), "write 255 where the maps have data")
        } else {
            let message = format!("has {largest} as its largest value, and 255 means covered");
            (message, "multiply by 255")
        };
        let id = if largest == 0 { "coverage-empty" } else { "coverage-values" };
        findings.push(Finding::error(id, COVERAGE, message, fix).with(evidence));
        return;
    }
    let soft = count(|value| value != 0 && value != 255);
    if soft as f64 / total > SOFT_FRACTION {
        let percent = 100.0 * soft as f64 / total;
        let message = format!("has values between 0 and 255 in {percent:.1} % of its texels");
        let fix =
            "write 255 where the maps have data, else 0; a trust from 0 to 1 is confidence.exr";
        let evidence = [("share", soft as f64 / total)];
        findings.push(Finding::warning("coverage-values", COVERAGE, message, fix).with(evidence));
    }
    let covered = reduced(map);
    let fix = "write 255 where the maps have data and 0 elsewhere, not the other way around";
    let Some(witness) = witness else {
        // A chart lies inside the square: its corners are empty and its middle is not.
        let at = |x: usize, y: usize| covered[y * SIDE + x];
        let far = SIDE - 1;
        let corners = at(0, 0) && at(far, 0) && at(0, far) && at(far, far);
        if corners && !at(SIDE / 2, SIDE / 2) {
            let message = "covers its four corners and not its middle".to_owned();
            findings.push(Finding::warning("coverage-inverted", COVERAGE, message, fix));
        }
        return;
    };
    let inverse: Vec<bool> = covered.iter().map(|covered| !covered).collect();
    let (as_it_is, inverted) = (overlap(&covered, &witness.seen), overlap(&inverse, &witness.seen));
    if inverted > as_it_is && inverted > 0.5 {
        let message = format!(
            "is inverted: it overlaps what the training views see by {as_it_is:.2}, its inverse by \
             {inverted:.2}"
        );
        let evidence = [("overlap_as_it_is", as_it_is), ("overlap_inverted", inverted)];
        findings.push(Finding::warning("coverage-inverted", COVERAGE, message, fix).with(evidence));
    } else if let Some(finding) = of_coverage(&covered, witness) {
        findings.push(finding);
    } else {
        let seen = witness.seen.iter().filter(|seen| **seen).count().max(1) as f64;
        let pairs = covered.iter().zip(&witness.seen);
        let fraction = pairs.filter(|(covered, seen)| **covered && **seen).count() as f64 / seen;
        if fraction < MIN_FRACTION {
            let percent = 100.0 * fraction;
            let message =
                format!("covers {percent:.0} % of what the training views see of the chart");
            let fix = "write 255 wherever a training view sees the face, or solve the rest";
            let evidence = [("share", fraction)];
            let finding = Finding::warning("coverage-small", COVERAGE, message, fix);
            findings.push(finding.with(evidence));
        }
    }
}

/// The coverage at the size at which maps are compared.
pub(super) fn reduced(map: &GrayImage) -> Vec<bool> {
    let data = map.data.iter().map(|value| f32::from(*value)).collect();
    let picture = Picture { width: map.width, height: map.height, channels: 1, data };
    // Empty texels do not count in the mean, so that a cell is as bright as its covered part;
    // half of a cell decides on whether it is covered.
    let reduced = Reduced::of(&Picture {
        data: picture.data.iter().map(|value| value + 1.0).collect(),
        ..picture
    });
    (0..SIDE * SIDE).map(|texel| reduced.data[texel] > f32::from(COVERED)).collect()
}

/// The texels of a map that count: what its coverage covers, else what the training views see,
/// else what is not empty.
pub(super) fn covered(
    map: &Picture,
    coverage: Option<&GrayImage>,
    witness: Option<&Witness>,
) -> Vec<bool> {
    let (width, height) = (map.width, map.height);
    let usable = coverage.filter(|coverage| {
        (coverage.width, coverage.height) == (width, height)
            && coverage.data.iter().any(|value| *value >= COVERED)
    });
    match (usable, witness) {
        (Some(coverage), _) => coverage.data.iter().map(|value| *value >= COVERED).collect(),
        (None, Some(witness)) => {
            let at = |i: usize, size: usize| (2 * i + 1) * SIDE / (2 * size);
            let seen = |texel: usize| {
                witness.seen[at(texel / width, height) * SIDE + at(texel % width, width)]
            };
            (0..width * height).map(seen).collect()
        }
        (None, None) => {
            let texels = map.data.chunks_exact(map.channels);
            let filled: Vec<bool> = texels.map(|v| v.iter().any(|value| *value != 0.0)).collect();
            if filled.contains(&true) { filled } else { vec![true; width * height] }
        }
    }
}
