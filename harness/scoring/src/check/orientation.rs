//! The orientation of maps: the albedo against the photographs, the coverage against the
//! chart, and without a capture the maps against their own coverage.

use formats::picture::Picture;

use super::bands::Bands;
use super::finding::Finding;
use super::folder::{COVERAGE, MapFolder};
use super::reduced::{Reduced, SIDE};
use super::symmetry::Symmetry;
use super::witness::Witness;

/// The least correlation that counts as evidence; right albedos reach 0.25 to 0.8.
const MIN_CORRELATION: f64 = 0.15;
/// The least advantage of another orientation; wrong orientations of right albedos reach 0.1.
const MIN_GAIN: f64 = 0.12;
/// By how much more the asymmetric part must correlate when mirrored: right maps lose by .15 to 1,
/// so that mirrored ones gain that. The whole pattern may then fit worse only by a tie.
const MIRRORED: f64 = 0.14;
const TIE: f64 = 0.03;
/// Overlap from which a coverage lies well, and how much better another way must fit.
const GOOD_OVERLAP: f64 = 0.9;
const OVERLAP_GAIN: f64 = 0.08;
/// Shares of empty texels between which emptiness has a shape.
const EMPTY: std::ops::Range<f64> = 0.05..0.95;

/// Compares the pattern of an albedo with the mean projected texture.
pub(super) fn of_albedo(file: &str, map: &Reduced, witness: &Witness) -> Option<Finding> {
    let Witness { texture, lit, .. } = witness;
    let reference = Bands::of(texture, &texture.data, &texture.valid, lit);
    let undone = |symmetry: Symmetry| {
        let pixels: Vec<[f32; 3]> = map
            .data
            .chunks_exact(3)
            .map(|rgb| std::array::from_fn(|channel| rgb[channel]))
            .collect();
        let values = symmetry.undone(&pixels, SIDE).concat();
        Bands::of(map, &values, &symmetry.undone(&map.valid, SIDE), lit)
    };
    let ways = Symmetry::ALL.map(|symmetry| {
        let bands = undone(symmetry);
        (symmetry, bands.correlation(&reference), bands.asymmetry(&reference))
    });
    let of = |wanted: Symmetry| ways.iter().find(|way| way.0 == wanted);
    let &(_, as_it_is, _) = of(Symmetry::Identity)?;
    let &(best, best_fit, _) = ways.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let &(_, other_fit, _) = of(best.mirrored())?;
    // A face and its mirror image fit nearly equally; what is asymmetric decides.
    let pair = [best, best.mirrored()];
    let upright = if pair.contains(&Symmetry::Identity) { Symmetry::Identity } else { best };
    let &(_, upright_fit, asymmetry) = of(upright)?;
    let &(_, mirrored_fit, mirrored_asymmetry) = of(upright.mirrored())?;
    let found = if (best_fit - other_fit).abs() > MIN_GAIN {
        best
    } else if mirrored_asymmetry > asymmetry + MIRRORED && mirrored_fit > upright_fit - TIE {
        upright.mirrored()
    } else {
        upright
    };
    let clear = best_fit > MIN_CORRELATION
        && (found == Symmetry::Identity.mirrored() || best_fit > as_it_is + MIN_GAIN);
    if found == Symmetry::Identity || !clear {
        return None;
    }
    let (id, wrong, fix) = found.words();
    let fit = of(found)?.1;
    let message = if found == Symmetry::MirroredU && upright_fit > MIN_CORRELATION {
        format!(
            "{wrong}: what is asymmetric of its pattern correlates with the projected photographs \
             by {asymmetry:.2} as it is, {mirrored_asymmetry:.2} mirrored"
        )
    } else {
        format!(
            "{wrong}: its pattern correlates with the projected photographs by {as_it_is:.2} as it \
             is, {fit:.2} that way"
        )
    };
    Some(Finding::warning(id, file, message, fix).with([
        ("correlation_as_it_is", as_it_is),
        ("correlation_undone", fit),
        ("asymmetry_as_it_is", of(Symmetry::Identity)?.2),
        ("asymmetry_undone", of(found)?.2),
    ]))
}

/// Compares the shape of a coverage with what the training views see of the chart.
pub(super) fn of_coverage(covered: &[bool], witness: &Witness) -> Option<Finding> {
    let reference = "what the training views see of the chart";
    of_shape(COVERAGE, covered, &witness.seen, reference)
}

/// Compares where maps are empty with their coverage.
pub(super) fn of_empty_texels(maps: &MapFolder, covered: &[bool], findings: &mut Vec<Finding>) {
    let coloured = |map: &&(&str, &Picture)| map.1.channels == 3;
    for (file, map) in maps.pictures().collect::<Vec<_>>().iter().filter(coloured) {
        let filled = Reduced::of(map).valid;
        let fraction = filled.iter().filter(|filled| **filled).count() as f64 / filled.len() as f64;
        if EMPTY.contains(&fraction) {
            findings.extend(of_shape(file, &filled, covered, COVERAGE));
        }
    }
}

fn of_shape(file: &str, shape: &[bool], reference: &[bool], named: &str) -> Option<Finding> {
    let overlaps =
        Symmetry::ALL.map(|symmetry| (symmetry, overlap(&symmetry.undone(shape, SIDE), reference)));
    let as_it_is = overlaps[0].1;
    let &(best, fit) = overlaps.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    if as_it_is > GOOD_OVERLAP || fit < as_it_is + OVERLAP_GAIN {
        return None;
    }
    let (id, wrong, fix) = best.words();
    let message = format!(
        "{wrong}: its filled texels overlap {named} by {as_it_is:.2} as they are, {fit:.2} that way"
    );
    let evidence = [("overlap_as_it_is", as_it_is), ("overlap_undone", fit)];
    Some(Finding::warning(id, file, message, fix).with(evidence))
}

/// Intersection over union, 0 to 1.
pub(super) fn overlap(a: &[bool], b: &[bool]) -> f64 {
    let count =
        |keep: fn(bool, bool) -> bool| a.iter().zip(b).filter(|(a, b)| keep(**a, **b)).count();
    count(|a, b| a && b) as f64 / count(|a, b| a || b).max(1) as f64
}
