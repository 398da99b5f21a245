//! The diffuse albedo's values: their range, coding, exposure, and the order of their channels.

use formats::picture::Picture;

use super::bands::Bands;
use super::finding::Finding;
use super::reduced::{Reduced, SIDE, median, quantile};
use super::witness::{Witness, brightness};

/// Fraction of covered texels that may lie outside of 0 to 1: rounding, a highlight that is left.
const OUTSIDE_FRACTION: f64 = 0.02;
/// A value below this is negative, not rounded.
const NEGATIVE: f32 = -1e-3;
/// Median from which values are counts of 8 bits.
const BYTES: f64 = 5.0;
/// Spread of a map's values, relative to its median, below which it is one colour.
const CONSTANT: f64 = 1e-4;
/// No skin is brighter or darker (luminance of the diffuse albedo).
const BRIGHTEST_SKIN: f64 = 0.85;
const DARKEST_SKIN: f64 = 0.004;
/// The factor to the pictures beyond which the exposure of skin is unlikely.
const BRIGHT_SKIN: f64 = 0.5;
const DARK_SKIN: f64 = 0.05;
/// Factors to the mean projected texture that right albedos keep to with well-exposed pictures:
/// .6 to 1.9 was measured, from one softbox to a uniform sphere.
const FACTORS: std::ops::Range<f64> = 0.4..2.5;

/// The faults of the values; `covered` are the texels that count, `own` says that our solver wrote
/// them, which encodes nothing.
pub(super) fn check(
    file: &str,
    map: &Picture,
    covered: &[bool],
    own: bool,
    witness: Option<&Witness>,
    findings: &mut Vec<Finding>,
) {
    let texels = || {
        let texels = map.data.chunks_exact(3).zip(covered).filter(|(_, covered)| **covered);
        texels.map(|(rgb, _)| rgb).filter(|rgb| rgb.iter().all(|v| v.is_finite()))
    };
    let total = texels().count();
    let Some(middle) = median(texels().flatten().copied()) else { return };
    let extreme = |q: f64| quantile(texels().flatten().copied(), q).unwrap_or(middle);
    let (low, high) = (extreme(0.0), extreme(1.0));
    if low == 0.0 && high == 0.0 {
        let fix = "write linear reflectance, 0 to 1";
        let message = "is black in every covered texel".to_owned();
        findings.push(Finding::error("black", file, message, fix));
        return;
    }
    let negative = texels().filter(|rgb| rgb.iter().any(|v| *v < NEGATIVE)).count();
    let fraction = negative as f64 / total as f64;
    if fraction > OUTSIDE_FRACTION {
        let percent = 100.0 * fraction;
        let message =
            format!("is negative in {percent:.1} % of its covered texels (down to {low:.3})");
        let fix = "write reflectance, 0 to 1; a value range of -1 to 1 is (x + 1) / 2";
        let evidence = [("share", fraction), ("minimum", low)];
        findings.push(Finding::warning("negative", file, message, fix).with(evidence));
    }
    if middle > BYTES {
        let message =
            format!("is coded from 0 to 255: its median is {middle:.0}, its maximum {high:.0}");
        let fix = "divide by 255, and undo the sRGB curve if it came from an 8-bit picture";
        let evidence = [("median", middle), ("maximum", high)];
        findings.push(Finding::warning("coded-0-255", file, message, fix).with(evidence));
        return;
    }
    let colours = Colours::of(map, texels(), witness);
    // Each channel for itself: a map of one colour may well have three values.
    let spread = |channel: usize| {
        let of = |q| quantile(texels().map(move |rgb| rgb[channel]), q).unwrap_or(0.0);
        (of(1.0) - of(0.0)) / of(0.5).abs().max(1e-9)
    };
    if high <= 1.0 && low > f64::from(NEGATIVE) && (0..3).all(|channel| spread(channel) < CONSTANT)
    {
        // One colour of the right kind is what a baseline makes of a face without labels.
        if !colours.is_plausible() {
            let message = format!("has one colour all over (median {middle:.3})");
            let fix = "check that the solver's albedo is written, not its initial value";
            let evidence = [("median", middle)];
            findings.push(Finding::warning("constant", file, message, fix).with(evidence));
        }
        return;
    }
    let above = texels().filter(|rgb| rgb.iter().any(|v| *v > 1.0)).count();
    let fraction = above as f64 / total as f64;
    // No curve takes a reflectance above 1.
    let encoded = || colours.encoded(file).filter(|_| !own && fraction <= OUTSIDE_FRACTION);
    if let Some(finding) = colours.swapped(file).or_else(encoded) {
        findings.push(finding);
        return;
    }
    let exposed = colours.exposed(file);
    if fraction <= OUTSIDE_FRACTION {
        findings.extend(exposed);
        return;
    }
    let percent = 100.0 * fraction;
    let message = format!(
        "is above 1 in {percent:.1} % of its covered texels (up to {high:.2}): brighter than \
         white, the exposure is unknown"
    );
    let fix = if own {
        "scale it by a reflectance that is known, or solve with reflectance.exposure_deviation = 1"
    } else {
        "divide by the exposure; if it is radiance or encoded, write linear reflectance, 0 to 1"
    };
    let id = if exposed.is_some() { "exposure" } else { "above-one" };
    let evidence = [
        ("share", fraction),
        ("maximum", high),
        ("median_luminance", colours.luminance),
        ("factor", colours.factor().unwrap_or(f64::NAN)),
    ];
    findings.push(Finding::warning(id, file, message, fix).with(evidence));
}

/// Statistics of colour and brightness, beside the projected photographs where there are some.
struct Colours {
    /// Median luminance.
    luminance: f64,
    /// Median of ln(red / blue).
    redness: f64,
    photographs: Option<Photographs>,
}

struct Photographs {
    /// Median of the map's luminance over the projected texture's, in lit texels.
    factor: f64,
    /// Medians of ln(red / blue) of map and projected texture there.
    redness: f64,
    redness_of_map: f64,
    /// Correlation of the patterns of red over blue.
    correlation: f64,
}

impl Colours {
    fn of<'a>(
        map: &Picture,
        texels: impl Iterator<Item = &'a [f32]>,
        witness: Option<&Witness>,
    ) -> Self {
        let pairs: Vec<(f32, f32)> =
            texels.map(|rgb| (brightness(rgb) as f32, redness(rgb))).collect();
        let photographs = witness.and_then(|witness| Photographs::of(&Reduced::of(map), witness));
        Self {
            luminance: median(pairs.iter().map(|pair| pair.0)).unwrap_or(0.0),
            redness: median(pairs.iter().map(|pair| pair.1)).unwrap_or(0.0),
            photographs,
        }
    }

    /// Returns whether one colour could be the face's: not grey, and near that of the photographs.
    fn is_plausible(&self) -> bool {
        let near = |photographs: &Photographs| {
            let Photographs { factor, redness, redness_of_map, .. } = *photographs;
            FACTORS.contains(&factor) && (redness_of_map - redness).abs() < 0.5
        };
        self.redness.abs() > 0.01 && self.photographs.as_ref().is_none_or(near)
    }

    /// Blue where the photographs are red. No skin is bluer than red, whatever the light.
    fn swapped(&self, file: &str) -> Option<Finding> {
        let Photographs { redness, redness_of_map, correlation, .. } =
            *self.photographs.as_ref()?;
        let nearer = (redness_of_map - redness).abs() - (redness_of_map + redness).abs();
        let swapped =
            redness_of_map < -0.1 && self.redness < -0.1 && (nearer > 0.3 || correlation < -0.15);
        swapped.then(|| {
            let (map, photographs) = (redness_of_map.exp(), redness.exp());
            let message = format!(
                "has red and blue swapped: red / blue is {map:.2}, in the projected photographs \
                 {photographs:.2}, and skin is never bluer than red"
            );
            let fix = "write its channels as R, G, B (they are B, G, R)";
            Finding::warning("bgr", file, message, fix).with([
                ("red_over_blue", map),
                ("red_over_blue_of_photographs", photographs),
                ("chroma_correlation", correlation),
            ])
        })
    }

    /// A curve of about 1 / 2.2 halves the logarithms: colours pale, and all is brighter than the
    /// photographs by more than shading explains. Right albedos stay on the other side of both.
    fn encoded(&self, file: &str) -> Option<Finding> {
        let Photographs { factor, redness, redness_of_map, .. } = *self.photographs.as_ref()?;
        let power = redness_of_map / redness;
        let (brighter, paler) = (factor > 1.95 && power < 0.83, factor > 1.8 && power < 0.55);
        let bright = self.luminance > 0.15 && self.luminance < 1.0;
        let encoded = (brighter || paler)
            && redness > 0.1
            && redness_of_map > 0.0
            && self.redness < 0.85
            && bright;
        encoded.then(|| {
            let message = format!(
                "is {factor:.1} times as bright as the projected photographs and its colours are \
                 paler (ln(red / blue) is {power:.2} of theirs; linear ones have 0.8 to 1.7), as \
                 sRGB-encoded values are"
            );
            let fix = "if they are, undo the sRGB curve; if they are linear, the photographs' \
                        exposure is unknown: divide by it";
            Finding::warning("srgb-encoded", file, message, fix).with([
                ("factor", factor),
                ("power", power),
                ("median_luminance", self.luminance),
            ])
        })
    }

    /// The map's brightness over that of the photographs.
    fn factor(&self) -> Option<f64> {
        self.photographs.as_ref().map(|photographs| photographs.factor)
    }

    /// A factor that no skin and no shading explains.
    fn exposed(&self, file: &str) -> Option<Finding> {
        let luminance = self.luminance;
        let factor = self.factor();
        let (bright, dark) = match factor {
            Some(factor) => (
                luminance > BRIGHTEST_SKIN || (luminance > BRIGHT_SKIN && factor > FACTORS.end),
                luminance < DARK_SKIN && factor < FACTORS.start,
            ),
            None => (luminance > BRIGHTEST_SKIN, luminance < DARKEST_SKIN),
        };
        (bright || dark).then(|| {
            let than = if bright { "brighter" } else { "darker" };
            let beside = factor.map_or_else(String::new, |factor| {
                format!(", {factor:.2} times the projected photographs")
            });
            let message = format!(
                "holds an exposure: its median luminance is {luminance:.4}{beside}, {than} than skin"
            );
            let fix = "divide by the exposure; an albedo is reflectance, 0.03 to 0.6 for skin";
            let evidence =
                [("median_luminance", luminance), ("factor", factor.unwrap_or(f64::NAN))];
            Finding::warning("exposure", file, message, fix).with(evidence)
        })
    }
}

impl Photographs {
    /// Returns `None` where too little is lit.
    fn of(map: &Reduced, witness: &Witness) -> Option<Self> {
        let Witness { texture, lit, .. } = witness;
        let texels: Vec<usize> =
            (0..SIDE * SIDE).filter(|texel| lit[*texel] && map.valid[*texel]).collect();
        let over = |of: &dyn Fn(usize) -> f32| median(texels.iter().map(|texel| of(*texel)));
        let bands = |map: &Reduced| Bands::of(map, &map.data, &map.valid, lit);
        Some(Self {
            factor: over(&|t| (brightness(map.texel(t)) / brightness(texture.texel(t))) as f32)?,
            redness: over(&|t| redness(texture.texel(t)))?,
            redness_of_map: over(&|t| redness(map.texel(t)))?,
            correlation: bands(map).chroma_correlation(&bands(texture)),
        })
    }
}

/// ln(red / blue).
fn redness(rgb: &[f32]) -> f32 {
    let clamped = |value: f32| value.max(1e-6);
    (clamped(rgb[0]) / clamped(rgb[2])).ln()
}
