//! Quantities of metrics at every pixel of a region.

use super::colour::{ciede2000, log, srgb, typology_angle};
use super::deviation::over_deviation;
use super::neighbourhood::{band, flip, high_pass, low_pass_error, ssim};
use super::pair::triple;
use super::rank::{ranks, upper_half};
use super::{MetricError, Pair, Protocol};

/// Keeps the relative squared error finite in the dark.
pub const RELATIVE_OFFSET: f64 = 0.01;

/// A per-pixel quantity; x of one or (x, y) of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Mean over the channels of (p - g)², as is.
    SquaredError,
    /// Mean over the channels of (p - g)² of sRGB values in [0, 1].
    SquaredErrorSrgb,
    /// Mean over the channels of (p - g)² / (g + .01)².
    RelativeSquaredError,
    /// Structural similarity of sRGB values, -1 to 1.
    Ssim,
    /// LDR-FLIP of sRGB pictures, 0 to 1.
    Flip,
    /// Angle between two vectors, degrees; 90 where one of them has no length.
    Angle,
    /// CIEDE2000 of linear colours clipped to [0, 1], D65.
    ColourDifference,
    /// (Individual typology angle of p, of g), degrees.
    Typology,
    /// (Luminance of p, of g); of one channel, the values.
    Luminance,
    /// Their ranks, ties sharing the mean rank.
    Ranks,
    /// (p·g, p·p), whose ratio is the factor that aligns p with g.
    Projection,
    /// (High-pass log luminance of p, of g).
    HighPass,
    /// (Log luminance of p, of g), each less its mean within the label.
    WithinLabel,
    /// Low-pass difference of the log luminances.
    LowPassError,
    /// (Difference of the log luminances, log luminance of the leaking layer).
    LogErrorAndCause,
    /// (Difference of the luminances, luminance of the leaking layer).
    ErrorAndCause,
    /// Ranks of (the confidence, the size of the difference of the log luminances).
    TrustAndErrorRanks,
    /// (Twice the size of the difference of the log luminances where the confidence is in its upper
    /// half, the same everywhere), whose ratio is that of their means.
    TrustedAndWholeError,
    /// Root mean square over the channels of |p - g| over so many stated standard deviations.
    ErrorOverDeviation(u8),
    /// Mean over the channels of (a - b)(a' - b'), a and b being independent halves of the samples
    /// of prediction and truth, a' and b' the others: the squared error without what noise adds.
    CrossProduct,
    /// [`Self::CrossProduct`] of sRGB values in [0, 1], whose curve is bent by the noise of a half.
    CrossProductSrgb,
    /// Angle between two colours, degrees; 90 where one of them is black.
    ColourAngle,
    /// Difference of the log luminances.
    LogError,
    /// The square of the preceding quantity.
    SquaredLogError,
    /// (Log luminance of p, of g), of what lies between Gaussians of so many texels and of twice that.
    Band(u8),
    /// (Angle between p and the mesh's normal where the truth has the mesh's, 1 there), else zeros.
    InventedRelief,
    /// (Area times [`Self::SquaredErrorSrgb`], area), whose ratio is the mean over the surface.
    AreaSquaredErrorSrgb,
    /// (Area times [`Self::Angle`], area).
    AreaAngle,
    /// The squared error of another benchmark's protocol.
    Compatible(Protocol),
    /// A network's distance of the pictures, which is computed elsewhere.
    Perceptual,
    /// A user's function, which is called elsewhere.
    Own,
}

/// The truth is flat within this angle of the mesh's normal, degrees.
const FLAT_DEGREES: f64 = 0.5;

impl Quantity {
    /// The input beside prediction and truth, by its argument's name in Python; none if those are all.
    pub fn needs(self) -> Option<&'static str> {
        match self {
            Self::WithinLabel => Some("labels"),
            Self::LogErrorAndCause => Some("shading"),
            Self::ErrorAndCause => Some("specular"),
            Self::TrustAndErrorRanks | Self::TrustedAndWholeError => Some("confidence"),
            Self::ErrorOverDeviation(_) => Some("deviation"),
            Self::CrossProduct | Self::CrossProductSrgb => Some("halves"),
            Self::InventedRelief => Some("mesh_normal"),
            Self::AreaSquaredErrorSrgb | Self::AreaAngle => Some("area"),
            Self::SquaredError
            | Self::SquaredErrorSrgb
            | Self::RelativeSquaredError
            | Self::Ssim
            | Self::Flip
            | Self::Angle
            | Self::ColourDifference
            | Self::Typology
            | Self::Luminance
            | Self::Ranks
            | Self::Projection
            | Self::HighPass
            | Self::ColourAngle
            | Self::LogError
            | Self::SquaredLogError
            | Self::Band(_)
            | Self::Compatible(_)
            | Self::Perceptual
            | Self::Own
            | Self::LowPassError => None,
        }
    }

    /// The colour space, or the unit, of the values that are compared; as reports show it.
    pub fn space(self) -> &'static str {
        match self {
            Self::SquaredError
            | Self::RelativeSquaredError
            | Self::Ranks
            | Self::Projection
            | Self::CrossProduct
            | Self::ColourAngle
            | Self::ErrorOverDeviation(_)
            | Self::Own => "linear",
            Self::Compatible(Protocol::OrbHdr | Protocol::OrbAlbedo) => "linear, as there",
            Self::Compatible(_) => "gamma, as there",
            Self::SquaredErrorSrgb | Self::CrossProductSrgb | Self::AreaSquaredErrorSrgb => {
                "sRGB clipped to [0, 1]"
            }
            Self::Ssim | Self::Flip | Self::Perceptual => "sRGB clipped to [0, 1], black outside",
            Self::ColourDifference | Self::Typology => "L*a*b*, D65",
            Self::Angle | Self::AreaAngle | Self::InventedRelief => "object space",
            Self::HighPass
            | Self::WithinLabel
            | Self::LowPassError
            | Self::LogErrorAndCause
            | Self::TrustAndErrorRanks
            | Self::LogError
            | Self::SquaredLogError
            | Self::Band(_)
            | Self::TrustedAndWholeError => "log luminance",
            Self::Luminance | Self::ErrorAndCause => "linear luminance",
        }
    }

    /// One or two numbers per pixel of the region, in its order. `metric` is named in errors.
    pub(super) fn measure(
        self,
        pair: &Pair,
        metric: &'static str,
    ) -> Result<Vec<f64>, MetricError> {
        let argument = self.needs().unwrap_or_default();
        let needs = |input| MetricError::Needs { metric, input, argument };
        self.check_channels(pair, metric)?;
        Ok(match self {
            Self::SquaredError => per_channel(pair, |p, g| (p - g).powi(2)),
            Self::SquaredErrorSrgb => squared_error_srgb(pair),
            Self::AreaSquaredErrorSrgb | Self::AreaAngle => {
                let area =
                    pair.over_region(pair.area).ok_or_else(|| needs("the area of every texel"))?;
                let values = match self {
                    Self::AreaAngle => triples(pair, angle_degrees),
                    _ => squared_error_srgb(pair),
                };
                area.into_iter().zip(values).flat_map(|(area, x)| [area * x, area]).collect()
            }
            Self::RelativeSquaredError => {
                per_channel(pair, |p, g| ((p - g) / (g + RELATIVE_OFFSET)).powi(2))
            }
            Self::Ssim => ssim(pair),
            Self::Flip => flip(pair),
            Self::Angle | Self::ColourAngle => triples(pair, angle_degrees),
            Self::ColourDifference => {
                let [p, g] = pair.lab();
                p.iter().zip(g).map(|(p, g)| ciede2000(*p, *g)).collect()
            }
            Self::Typology => {
                let [p, g] = pair.lab();
                p.iter().zip(g).flat_map(|(p, g)| [*p, *g].map(typology_angle)).collect()
            }
            Self::Luminance => pixels(pair)
                .flat_map(|i| [pair.predicted_luminance(i), pair.true_luminance(i)])
                .collect(),
            Self::Ranks => {
                let x: Vec<f64> = pixels(pair).map(|i| pair.predicted_luminance(i)).collect();
                let y: Vec<f64> = pixels(pair).map(|i| pair.true_luminance(i)).collect();
                ranks(&x).into_iter().zip(ranks(&y)).flat_map(|(x, y)| [x, y]).collect()
            }
            Self::Projection => pixels(pair)
                .flat_map(|i| {
                    let both = pair.predicted(i).zip(pair.true_values(i));
                    both.fold([0.0, 0.0], |[pg, pp], (p, g)| [pg + p * g, pp + p * p])
                })
                .collect(),
            Self::HighPass => {
                let mut residues = high_pass(pair);
                residues.iter_mut().for_each(drop_rounding);
                residues
            }
            Self::WithinLabel => {
                let labels = pair.labels.ok_or_else(|| needs("labels"))?;
                let [mut x, mut y] = pair.log_luminances().clone();
                let of: Vec<u8> = pixels(pair).map(|i| labels.data[i]).collect();
                [&mut x, &mut y].into_iter().for_each(|values| centre_by_label(values, &of));
                x.into_iter().zip(y).flat_map(|(x, y)| [x, y]).collect()
            }
            Self::LowPassError => low_pass_error(pair),
            Self::LogErrorAndCause => {
                let cause = pair.cause_luminances().ok_or_else(|| needs("the true shading"))?;
                signed_log_errors(pair)
                    .zip(cause)
                    .flat_map(|(error, cause)| [error, log(cause)])
                    .collect()
            }
            Self::ErrorAndCause => {
                let cause =
                    pair.cause_luminances().ok_or_else(|| needs("the true specular layer"))?;
                let errors =
                    pixels(pair).map(|i| pair.predicted_luminance(i) - pair.true_luminance(i));
                errors.zip(cause).flat_map(|(error, cause)| [error, cause]).collect()
            }
            Self::CrossProduct | Self::CrossProductSrgb => {
                let curve: fn(f64) -> f64 =
                    if self == Self::CrossProduct { |value| value } else { srgb };
                cross_products(pair, curve)
                    .ok_or_else(|| needs("halves of the samples of both pictures"))?
            }
            Self::Compatible(protocol) => protocol.errors(pair),
            Self::Perceptual | Self::Own => return Err(MetricError::Elsewhere { metric }),
            Self::LogError => signed_log_errors(pair).collect(),
            Self::SquaredLogError => signed_log_errors(pair).map(|error| error * error).collect(),
            Self::Band(texels) => {
                let mut bands = band(pair, f64::from(texels));
                bands.iter_mut().for_each(drop_rounding);
                bands
            }
            Self::InventedRelief => {
                let mesh = pair.cause.ok_or_else(|| needs("the mesh's normals"))?;
                pixels(pair)
                    .flat_map(|i| {
                        let [p, g] = [triple(pair.predicted(i)), triple(pair.true_values(i))];
                        let mesh = triple(pair.channels(mesh, i));
                        let flat = f64::from(angle_degrees(g, mesh) < FLAT_DEGREES);
                        [flat * angle_degrees(p, mesh), flat]
                    })
                    .collect()
            }
            Self::TrustAndErrorRanks => {
                let trust =
                    pair.over_region(pair.confidence).ok_or_else(|| needs("a confidence"))?;
                let errors = ranks(&log_errors(pair));
                ranks(&trust).into_iter().zip(errors).flat_map(|(x, y)| [x, y]).collect()
            }
            Self::ErrorOverDeviation(count) => {
                let errors = over_deviation(pair).ok_or_else(|| needs("standard deviations"))?;
                errors.iter().map(|error| error / f64::from(count)).collect()
            }
            Self::TrustedAndWholeError => {
                let trust =
                    pair.over_region(pair.confidence).ok_or_else(|| needs("a confidence"))?;
                let weights = upper_half(&trust);
                let pairs = weights.into_iter().zip(log_errors(pair));
                pairs.flat_map(|(weight, error)| [2.0 * weight * error, error]).collect()
            }
        })
    }

    fn check_channels(self, pair: &Pair, metric: &'static str) -> Result<(), MetricError> {
        let found = pair.truth.channels;
        let (expected, right) = match self {
            Self::Flip
            | Self::Angle
            | Self::AreaAngle
            | Self::ColourAngle
            | Self::InventedRelief
            | Self::Compatible(_)
            | Self::Perceptual
            | Self::Own
            | Self::ColourDifference
            | Self::Typology => ("3", found == 3),
            Self::SquaredError
            | Self::SquaredErrorSrgb
            | Self::AreaSquaredErrorSrgb
            | Self::RelativeSquaredError
            | Self::Ssim
            | Self::Luminance
            | Self::Ranks
            | Self::Projection
            | Self::HighPass
            | Self::WithinLabel
            | Self::LowPassError
            | Self::LogErrorAndCause
            | Self::ErrorAndCause
            | Self::TrustAndErrorRanks
            | Self::CrossProduct
            | Self::CrossProductSrgb
            | Self::LogError
            | Self::SquaredLogError
            | Self::Band(_)
            | Self::ErrorOverDeviation(_)
            | Self::TrustedAndWholeError => ("1 or 3", found == 1 || found == 3),
        };
        if right { Ok(()) } else { Err(MetricError::Channels { metric, expected, found }) }
    }
}

fn pixels<'a>(pair: &Pair<'a>) -> impl Iterator<Item = usize> + use<'a> {
    pair.region().pixels().iter().copied()
}

fn per_channel(pair: &Pair, error: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let channels = pair.truth.channels as f64;
    pixels(pair)
        .map(|i| {
            let both = pair.predicted(i).zip(pair.true_values(i));
            both.map(|(p, g)| error(p, g)).sum::<f64>() / channels
        })
        .collect()
}

fn squared_error_srgb(pair: &Pair) -> Vec<f64> {
    let ([p, g], channels) = (pair.srgb_of_region(), pair.truth.channels);
    let pixels = p.chunks_exact(channels).zip(g.chunks_exact(channels));
    let square = |(p, g): (&[f64], &[f64])| {
        p.iter().zip(g).map(|(p, g)| (p - g).powi(2)).sum::<f64>() / channels as f64
    };
    pixels.map(square).collect()
}

fn log_errors(pair: &Pair) -> Vec<f64> {
    signed_log_errors(pair).map(f64::abs).collect()
}

fn signed_log_errors(pair: &Pair) -> impl Iterator<Item = f64> {
    let [x, y] = pair.log_luminances();
    x.iter().zip(y).map(|(x, y)| x - y)
}

/// The two halves of a picture's samples; `None` without them. The second half is the mean less the first.
fn cross_products(pair: &Pair, curve: fn(f64) -> f64) -> Option<Vec<f64>> {
    let [half_p, half_g] = pair.halves?;
    let channels = pair.truth.channels;
    let of_pixel = |i: usize| {
        let both = pair.predicted(i).zip(pair.true_values(i));
        let halves = pair.scaled_channels(half_p, i).zip(pair.channels(half_g, i));
        let products = both.zip(halves).map(|((p, g), (a, b))| {
            (curve(a) - curve(b)) * (curve(2.0 * p - a) - curve(2.0 * g - b))
        });
        products.sum::<f64>() / channels as f64
    };
    Some(pixels(pair).map(of_pixel).collect())
}

fn triples(pair: &Pair, compare: impl Fn([f64; 3], [f64; 3]) -> f64) -> Vec<f64> {
    pixels(pair).map(|i| compare(triple(pair.predicted(i)), triple(pair.true_values(i)))).collect()
}

/// By the arc tangent: the arc cosine is flat where the angle is small.
fn angle_degrees(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    if dot(a, a) == 0.0 || dot(b, b) == 0.0 {
        return 90.0;
    }
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    dot(cross, cross).sqrt().atan2(dot(a, b)).to_degrees()
}

fn centre_by_label(values: &mut [f64], labels: &[u8]) {
    let mut sums = [(0.0, 0.0); 256];
    for (value, label) in values.iter().zip(labels) {
        let (sum, count) = &mut sums[usize::from(*label)];
        *sum += value;
        *count += 1.0;
    }
    for (value, label) in values.iter_mut().zip(labels) {
        let (sum, count) = sums[usize::from(*label)];
        *value -= sum / count;
        drop_rounding(value);
    }
}

/// Less than this of a logarithm is rounding; neighbouring floats differ by five hundred times more.
const ROUNDING: f64 = 1e-10;

/// A flat map less its mean is flat: what rounding leaves of it correlates with anything.
fn drop_rounding(residue: &mut f64) {
    if residue.abs() < ROUNDING {
        *residue = 0.0;
    }
}
