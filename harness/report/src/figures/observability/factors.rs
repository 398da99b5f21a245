//! Quantities that texels are told apart by, and the error in each of their bins.

use formats::picture::Picture;
use scoring::score::Observability;

use crate::tone::Field;

/// A bin with less than this share of the texels says nothing.
const LEAST: f64 = 1e-3;
/// PSNR of no error, dB, as in scores.
const EXACT: f64 = 100.0;

/// A quantity of every texel.
pub(super) struct Factor<'a> {
    pub name: &'static str,
    /// With its unit.
    pub label: &'static str,
    pub map: &'a Picture,
    /// The value at which the colours of its panel end.
    pub top: f32,
    /// True if the axis is logarithmic.
    pub logarithmic: bool,
    /// Bins begin at these and end below the next; the last one has no end.
    starts: &'static [f64],
}

/// Texels of like observation.
pub(super) struct Bin {
    /// The number of the bin.
    pub at: usize,
    pub from: f64,
    /// The end of the bin; none of the last bin.
    pub to: Option<f64>,
    /// The mean of the quantity.
    pub mean: f64,
    /// The share of all compared texels.
    pub share: f64,
    /// PSNR of the albedo.
    pub decibels: f64,
    /// Mean angle of the specular normal.
    pub degrees: Option<f64>,
}

impl Bin {
    /// As the columns of the CSV are named.
    pub fn values(&self) -> [Option<f64>; 6] {
        let Self { from, to, mean, share, decibels, degrees, .. } = *self;
        [Some(from), to, Some(mean), Some(share), Some(decibels), degrees]
    }
}

/// The factors of a capture.
pub(super) fn factors(seen: &Observability) -> Vec<Factor<'_>> {
    let shadow = seen.cast_shadow.as_ref().map(|map| Factor {
        name: "cast shadow",
        label: "share of the irradiance that is blocked",
        map,
        top: 1.0,
        logarithmic: false,
        starts: &[0.0, 0.05, 0.2, 0.4, 0.6, 0.8],
    });
    let saturation = seen.saturation.as_ref().map(|map| Factor {
        name: "saturation",
        label: "share of the views that are clipped",
        map,
        top: 1.0,
        logarithmic: false,
        starts: &[0.0, 1e-6, 0.25, 0.5, 0.75],
    });
    let always = [
        Factor {
            name: "views",
            label: "training views that see a texel",
            map: &seen.views,
            top: 10.0,
            logarithmic: false,
            starts: &[1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 15.0, 20.0],
        },
        Factor {
            name: "obliqueness",
            label: "least angle to a view, °",
            map: &seen.obliqueness,
            top: 90.0,
            logarithmic: false,
            starts: &[0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0],
        },
        Factor {
            name: "light",
            label: "true shading over its median",
            map: &seen.light,
            top: 2.0,
            logarithmic: true,
            starts: &[0.0, 0.125, 0.25, 0.5, 0.71, 1.0, 1.41, 2.0, 4.0],
        },
    ];
    always.into_iter().chain(shadow).chain(saturation).collect()
}

/// The method's own confidence in its texels.
pub(super) fn of_confidence(map: &Picture) -> Factor<'_> {
    Factor {
        name: "confidence",
        label: "the method's own confidence",
        map,
        top: 1.0,
        logarithmic: false,
        starts: &[0.0, 0.2, 0.4, 0.6, 0.8],
    }
}

impl Factor<'_> {
    /// The range of its panel's colours.
    pub fn scale(&self) -> String {
        format!("0 to {}", self.top)
    }

    /// The error of texels where `albedo` (RMS of sRGB values) is a number, in every bin with enough of them.
    pub fn bins(&self, albedo: &Field, normal: Option<&Field>) -> Vec<Bin> {
        #[derive(Clone, Copy, Default)]
        struct Sums {
            count: f64,
            value: f64,
            squared: f64,
            degrees: f64,
        }
        let mut sums = vec![Sums::default(); self.starts.len()];
        for (at, error) in albedo.values.iter().enumerate() {
            let value = f64::from(self.map.data[at]);
            let bin = self.starts.partition_point(|start| *start <= value);
            if error.is_nan() || bin == 0 {
                continue;
            }
            let sum = &mut sums[bin - 1];
            sum.count += 1.0;
            sum.value += value;
            sum.squared += f64::from(*error).powi(2);
            sum.degrees += normal.map_or(0.0, |normal| f64::from(normal.values[at]));
        }
        let all: f64 = sums.iter().map(|sum| sum.count).sum();
        let bin = |(at, sum): (usize, &Sums)| Bin {
            at,
            from: self.starts[at],
            to: self.starts.get(at + 1).copied(),
            mean: sum.value / sum.count,
            share: sum.count / all,
            decibels: (-10.0 * (sum.squared / sum.count).log10()).min(EXACT),
            degrees: normal.map(|_| sum.degrees / sum.count),
        };
        let enough = |(_, sum): &(usize, &Sums)| sum.count > 0.0 && sum.count >= LEAST * all;
        sums.iter().enumerate().filter(enough).map(bin).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bin_has_the_error_of_its_texels_alone() {
        let map = Picture { width: 4, height: 1, channels: 1, data: vec![0.1, 0.3, 0.35, 0.9] };
        let field = |values: &[f32]| Field { width: 4, height: 1, values: values.to_vec() };
        let bins = of_confidence(&map)
            .bins(&field(&[f32::NAN, 0.01, 0.03, 0.1]), Some(&field(&[9.0, 1.0, 3.0, 5.0])));
        let found: Vec<_> = bins.iter().map(|bin| (bin.at, bin.from, bin.to)).collect();
        assert_eq!(found, [(1, 0.2, Some(0.4)), (4, 0.8, None)]);
        // The mean of 0.01² and 0.03² is 5e-4.
        assert!(
            (bins[0].decibels - 33.0103).abs() < 1e-3 && (bins[1].decibels - 20.0).abs() < 1e-4
        );
        assert!((bins[0].mean - 0.325).abs() < 1e-6 && (bins[0].share - 2.0 / 3.0).abs() < 1e-9);
        assert_eq!((bins[0].degrees, bins[1].degrees), (Some(2.0), Some(5.0)));
    }
}
