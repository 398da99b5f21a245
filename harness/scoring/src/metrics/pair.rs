//! A prediction beside its truth: checked once, compared many times.

use std::sync::Arc;

use formats::picture::{GrayImage, Picture};

use super::colour::{lab, log, luminance, srgb};
use super::shared::{Both, Shared};
use super::{MetricError, Region};

/// Two pictures of one size and the region in which they are compared.
#[derive(Clone, Debug)]
pub struct Pair<'a> {
    pub(super) prediction: &'a Picture,
    pub(super) truth: &'a Picture,
    pub(super) region: &'a Region,
    pub(super) factor: [f64; 3],
    pub(super) labels: Option<&'a GrayImage>,
    pub(super) cause: Option<&'a Picture>,
    pub(super) confidence: Option<&'a Picture>,
    pub(super) deviation: Option<&'a Picture>,
    pub(super) halves: Option<[&'a Picture; 2]>,
    pub(super) area: Option<&'a Picture>,
    pub(super) shared: Arc<Shared>,
}

impl<'a> Pair<'a> {
    /// Checks that sizes and channels agree and that every value inside the region is finite.
    pub fn new(
        prediction: &'a Picture,
        truth: &'a Picture,
        region: &'a Region,
    ) -> Result<Self, MetricError> {
        check_size("prediction", (prediction.width, prediction.height), truth)?;
        check_size("region", region.size(), truth)?;
        if prediction.channels != truth.channels {
            let expected =
                if truth.channels == 1 { "1 (as the truth)" } else { "3 (as the truth)" };
            let found = prediction.channels;
            return Err(MetricError::Channels { metric: "a pair", expected, found });
        }
        check_finite("prediction", prediction, region)?;
        check_finite("truth", truth, region)?;
        Ok(Self {
            prediction,
            truth,
            region,
            factor: [1.0; 3],
            labels: None,
            cause: None,
            confidence: None,
            deviation: None,
            halves: None,
            area: None,
            shared: Arc::default(),
        })
    }

    /// The prediction's channels are multiplied by `factor` before anything else.
    pub fn scaled(mut self, factor: [f64; 3]) -> Self {
        self.factor = factor;
        self.shared = Arc::default();
        self
    }

    /// Region ids for the metrics that compare within a label.
    pub fn with_labels(mut self, labels: &'a GrayImage) -> Result<Self, MetricError> {
        check_size("label image", (labels.width, labels.height), self.truth)?;
        self.labels = Some(labels);
        Ok(self)
    }

    /// Sets the layer that may have leaked into the prediction (`leakage_*`), the true shading or
    /// specular one; for `relief_invented` the mesh's normals.
    pub fn with_cause(mut self, cause: &'a Picture) -> Result<Self, MetricError> {
        check_size("leaking layer", (cause.width, cause.height), self.truth)?;
        check_finite("leaking layer", cause, self.region)?;
        self.cause = Some(cause);
        Ok(self)
    }

    /// The method's confidence in each pixel of its prediction, one channel, larger for more.
    pub fn with_confidence(mut self, confidence: &'a Picture) -> Result<Self, MetricError> {
        self.check_values("confidence", confidence)?;
        self.confidence = Some(confidence);
        Ok(self)
    }

    /// The standard deviation that the method states for each value of its prediction, scaled with it: in its channels,
    /// or one for all of them.
    pub fn with_deviation(mut self, deviation: &'a Picture) -> Result<Self, MetricError> {
        check_size("deviation", (deviation.width, deviation.height), self.truth)?;
        let found = deviation.channels;
        if found != 1 && found != self.truth.channels {
            let expected = "1, or as many as the truth's";
            return Err(MetricError::Channels { metric: "deviation", expected, found });
        }
        check("deviation", deviation, self.region, |value| value.is_finite() && value >= 0.0)?;
        self.deviation = Some(deviation);
        Ok(self)
    }

    /// The surface area of each texel, one channel, any unit.
    pub fn with_area(mut self, area: &'a Picture) -> Result<Self, MetricError> {
        self.check_values("area", area)?;
        self.area = Some(area);
        Ok(self)
    }

    fn check_values(&self, what: &'static str, values: &Picture) -> Result<(), MetricError> {
        check_size(what, (values.width, values.height), self.truth)?;
        if values.channels != 1 {
            let found = values.channels;
            return Err(MetricError::Channels { metric: what, expected: "1", found });
        }
        check_finite(what, values, self.region)
    }

    /// The means of one half of the samples of prediction and truth, of pictures whose halves are
    /// independent; a picture without noise is its own half.
    pub fn with_halves(
        mut self,
        prediction: &'a Picture,
        truth: &'a Picture,
    ) -> Result<Self, MetricError> {
        for (what, half) in [("half of the prediction", prediction), ("half of the truth", truth)] {
            check_size(what, (half.width, half.height), self.truth)?;
            let found = half.channels;
            if found != self.truth.channels {
                let expected = "as many as the truth's";
                return Err(MetricError::Channels { metric: "a half", expected, found });
            }
            check_finite(what, half, self.region)?;
        }
        self.halves = Some([prediction, truth]);
        Ok(self)
    }

    /// The region.
    pub fn region(&self) -> &'a Region {
        self.region
    }

    /// The scaled prediction's channels at a row-major pixel index.
    pub(super) fn predicted(&self, index: usize) -> impl Iterator<Item = f64> {
        self.scaled_channels(self.prediction, index)
    }

    /// Any picture's channels, scaled as the prediction's are.
    pub(super) fn scaled_channels(
        &self,
        picture: &'a Picture,
        index: usize,
    ) -> impl Iterator<Item = f64> {
        let factors = self.factor.iter().cycle();
        self.channels(picture, index).zip(factors).map(|(value, factor)| value * factor)
    }

    /// The truth's channels at a row-major pixel index.
    pub(super) fn true_values(&self, index: usize) -> impl Iterator<Item = f64> {
        self.channels(self.truth, index)
    }

    /// The sRGB values of both pictures, channels interleaved.
    pub(super) fn srgb(&self) -> &Both<f64> {
        self.shared.srgb.get_or_init(|| {
            let pixels = self.truth.width * self.truth.height;
            [
                (0..pixels).flat_map(|i| self.predicted(i).map(srgb)).collect(),
                (0..pixels).flat_map(|i| self.true_values(i).map(srgb)).collect(),
            ]
        })
    }

    /// Prediction and truth as they are looked at: sRGB values in [0, 1], black outside the region.
    pub fn shown(&self) -> [Picture; 2] {
        let channels = self.truth.channels;
        self.srgb().each_ref().map(|values| {
            let mut data = vec![0.0; values.len()];
            for i in self.region.pixels() {
                for at in i * channels..(i + 1) * channels {
                    data[at] = values[at] as f32;
                }
            }
            Picture { data, ..*self.truth }
        })
    }

    /// The same in the region alone.
    pub(super) fn srgb_of_region(&self) -> &Both<f64> {
        self.shared.srgb_of_region.get_or_init(|| {
            let pixels = self.region.pixels();
            [
                pixels.iter().flat_map(|i| self.predicted(*i).map(srgb)).collect(),
                pixels.iter().flat_map(|i| self.true_values(*i).map(srgb)).collect(),
            ]
        })
    }

    /// L*a*b* in the region.
    pub(super) fn lab(&self) -> &Both<[f64; 3]> {
        self.shared.lab.get_or_init(|| {
            let pixels = self.region.pixels();
            [
                pixels.iter().map(|i| lab(triple(self.predicted(*i)))).collect(),
                pixels.iter().map(|i| lab(triple(self.true_values(*i)))).collect(),
            ]
        })
    }

    /// Natural logarithms of the luminances in the region.
    pub(super) fn log_luminances(&self) -> &Both<f64> {
        self.shared.log_luminances.get_or_init(|| {
            let pixels = self.region.pixels();
            [
                pixels.iter().map(|i| log(self.predicted_luminance(*i))).collect(),
                pixels.iter().map(|i| log(self.true_luminance(*i))).collect(),
            ]
        })
    }

    pub(super) fn predicted_luminance(&self, index: usize) -> f64 {
        luminance(self.predicted(index))
    }

    pub(super) fn true_luminance(&self, index: usize) -> f64 {
        luminance(self.true_values(index))
    }

    /// Luminances of the leaking layer over the region.
    pub(super) fn cause_luminances(&self) -> Option<impl Iterator<Item = f64>> {
        let cause = self.cause?;
        let pixels = self.region.pixels().iter();
        Some(pixels.map(move |i| luminance(self.channels(cause, *i))))
    }

    /// The values of one channel over the region.
    pub(super) fn over_region(&self, values: Option<&Picture>) -> Option<Vec<f64>> {
        let data = &values?.data;
        Some(self.region.pixels().iter().map(|i| f64::from(data[*i])).collect())
    }

    pub(super) fn channels(
        &self,
        picture: &'a Picture,
        index: usize,
    ) -> impl Iterator<Item = f64> + use<'a> {
        let channels = picture.channels;
        picture.data[index * channels..(index + 1) * channels].iter().map(|v| f64::from(*v))
    }
}

/// The three channels of a colour or a vector.
pub(super) fn triple(values: impl Iterator<Item = f64>) -> [f64; 3] {
    let mut triple = [0.0; 3];
    triple.iter_mut().zip(values).for_each(|(slot, value)| *slot = value);
    triple
}

fn check_size(
    what: &'static str,
    (found_width, found_height): (usize, usize),
    truth: &Picture,
) -> Result<(), MetricError> {
    let (width, height) = (truth.width, truth.height);
    if (found_width, found_height) == (width, height) {
        return Ok(());
    }
    Err(MetricError::Size { what, found_width, found_height, width, height })
}

fn check_finite(what: &'static str, picture: &Picture, region: &Region) -> Result<(), MetricError> {
    check(what, picture, region, f32::is_finite)
}

fn check(
    what: &'static str,
    picture: &Picture,
    region: &Region,
    is_valid: fn(f32) -> bool,
) -> Result<(), MetricError> {
    for &index in region.pixels() {
        let (x, y) = (index % picture.width, index / picture.width);
        let bad = picture.pixel(x, y).iter().position(|value| !is_valid(*value));
        if let Some(channel) = bad {
            let value = picture.pixel(x, y)[channel];
            return Err(MetricError::Value { what, value, x, y, channel });
        }
    }
    Ok(())
}
