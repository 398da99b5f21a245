//! The roughness map: GGX alphas of the two lobes, and the share of the first, the sharper one.

use formats::picture::Picture;

use super::finding::Finding;
use super::reduced::{median, quantile};

/// Alphas of skin: the sharp lobe has .15 to .3, the wide one .35 to .45; their square roots
/// .4 to .55 and .6 to .67. In between is neither.
const SHARP_ROOT: std::ops::Range<f64> = 0.36..0.62;
const WIDE_ROOT: f64 = 0.5;
/// Gloss turns the order around, and is high.
const GLOSS: f64 = 0.45;
const SMOOTH: f64 = 0.62;

/// The faults of the values of a map with alpha1, alpha2, share1.
pub(super) fn check(file: &str, map: &Picture, covered: &[bool], findings: &mut Vec<Finding>) {
    let values = |channel: usize| {
        let texels = map.data.chunks_exact(3).zip(covered).filter(|(_, covered)| **covered);
        texels.map(move |(values, _)| values[channel])
    };
    let (Some(sharp), Some(wide)) = (median(values(0)), median(values(1))) else { return };
    let bounds = |channel| {
        let of = |q| quantile(values(channel), q).unwrap_or(0.0);
        (of(0.01), of(0.99))
    };
    let evidence = [("median_alpha1", sharp), ("median_alpha2", wide)];
    for (channel, name) in ["alpha1", "alpha2", "share1"].iter().enumerate() {
        let (low, high) = bounds(channel);
        let minimum = if channel == 2 { -1e-3 } else { 1e-4 };
        if low >= minimum && high <= 1.0 + 1e-3 {
            continue;
        }
        let message = format!("has {name} from {low:.3} to {high:.3}, outside of 0 to 1");
        let fix = if high > 5.0 {
            "divide by 255, then square: alphas are squares of perceptual roughness"
        } else {
            "write GGX alphas above 0 and at most 1, and the first lobe's share"
        };
        let range = [("minimum", low), ("maximum", high)];
        findings.push(Finding::warning("range", file, message, fix).with(range));
        return;
    }
    let medians = format!("the medians of alpha1 and alpha2 are {sharp:.2} and {wide:.2}");
    let inverted = sharp > wide + 0.02;
    if sharp > SMOOTH || (inverted && sharp > GLOSS) {
        let message =
            format!("holds gloss (1 - roughness), not alpha: {medians}, skin's .2 and .4");
        let fix = "write alpha = (1 - gloss)^2, or 1 - gloss if that was 1 - alpha";
        findings.push(Finding::warning("gloss", file, message, fix).with(evidence));
    } else if SHARP_ROOT.contains(&sharp) && wide > WIDE_ROOT {
        let message =
            format!("holds perceptual roughness, not GGX alpha: {medians}, skin's .2 and .4");
        let fix = "write its square: alpha = roughness^2";
        findings.push(Finding::warning("perceptual-roughness", file, message, fix).with(evidence));
    }
}
