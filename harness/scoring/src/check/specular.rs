//! The specular albedo's range: reflectance at normal incidence, 0 to 0.05.

use formats::picture::Picture;

use super::finding::Finding;
use super::reduced::{median, quantile};

/// Largest value that still counts as within 0 to 0.05.
const LARGEST: f64 = 0.0525;
/// Networks without a bound reach -0.01 where the skin is dull.
const NEGATIVE: f64 = -0.025;
/// Indices of refraction of skin and what is on it.
const INDICES: std::ops::Range<f64> = 1.1..1.7;
/// The largest 0.05 after the sRGB curve, and the least of skin, 0.01.
const ENCODED: f64 = 0.26;
const ENCODED_SKIN: f64 = 0.1;
/// The largest 0.05 as a level of 0.08.
const LEVEL: f64 = 0.66;

/// The faults of the values; `covered` are the texels that count, `own` says that our solver wrote
/// them, which encodes nothing.
pub(super) fn check(
    file: &str,
    map: &Picture,
    covered: &[bool],
    own: bool,
    findings: &mut Vec<Finding>,
) {
    let values = || {
        let values = map.data.iter().zip(covered).filter(|(_, covered)| **covered);
        values.map(|(value, _)| *value)
    };
    let Some(middle) = median(values()) else { return };
    let of = |q| quantile(values(), q).unwrap_or(middle);
    let (minimum, low, high, maximum) = (of(0.0), of(0.02), of(0.98), of(1.0));
    let evidence = [("median", middle), ("q02", low), ("q98", high), ("maximum", maximum)];
    if minimum == 0.0 && maximum == 0.0 {
        let message = "is 0 in every covered texel: the face has no highlights".to_owned();
        let fix =
            "write reflectance at normal incidence, about 0.028 for skin, or leave the map out";
        findings.push(Finding::warning("black", file, message, fix));
        return;
    }
    if low < NEGATIVE {
        let message = format!("is negative: 2 % of its values are below {low:.3}");
        let fix = "write reflectance at normal incidence, 0 to 0.05";
        findings.push(Finding::warning("negative", file, message, fix).with(evidence));
    }
    if high <= LARGEST {
        return;
    }
    let beyond = format!("its median is {middle:.3} and 2 % are above {high:.3}, beyond 0.05");
    let (id, what, fix) = if middle > 5.0 {
        (
            "coded-0-255",
            "holds values of 0 to 255",
            "divide by 255, then by what 1 stands for: reflectance is 0 to 0.05",
        )
    } else if INDICES.contains(&middle) && INDICES.contains(&low) && high < INDICES.end {
        ("index-of-refraction", "holds indices of refraction n", "write ((n - 1) / (n + 1))^2")
    } else if high > 1.02 {
        ("range", "holds values above 1", "write reflectance at normal incidence, 0 to 0.05")
    } else if high < ENCODED && (own || middle < ENCODED_SKIN) {
        (
            "beyond-range",
            "is beyond what skin reflects",
            if own {
                "the exposure or the light is other than the solve took it: set \
                 reflectance.exposure_deviation = 1 if nobody knows the exposure"
            } else {
                "write reflectance at normal incidence, 0 to 0.05; if the values are sRGB-encoded \
                 or a specular level, undo that"
            },
        )
    } else if high < ENCODED {
        (
            "srgb-encoded",
            "is beyond what skin reflects, as sRGB-encoded values of 0 to 0.05 are",
            "if they are, undo the sRGB curve; if it is a specular level, multiply by 0.08: \
             reflectance at normal incidence is 0 to 0.05",
        )
    } else if high < LEVEL {
        (
            "specular-level",
            "is beyond what skin reflects, as a specular level is, which renderers take",
            "multiply by 0.08 (or by 0.05 if 1 stands for 0.05): reflectance is 0 to 0.05",
        )
    } else {
        (
            "range-0-1",
            "is beyond what skin reflects, as a share of the range, 0 to 1, is",
            "multiply by 0.05 (or by 0.08 if it is a specular level): reflectance is 0 to 0.05",
        )
    };
    let message = format!("{what}: {beyond}");
    findings.push(Finding::warning(id, file, message, fix).with(evidence));
}
