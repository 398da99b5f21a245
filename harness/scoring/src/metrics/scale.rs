//! Factors that align a prediction with its truth.

use serde::{Deserialize, Serialize};

use super::{MetricError, Pair, Quantity, Statistic};

/// Factors fitted once per subject, on map texels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scale {
    /// k = <p,g> / <p,p> over all channels.
    pub global: f64,
    /// Factor for each channel.
    pub channel: [f64; 3],
    /// Median of g/p for each channel, where p is positive.
    pub median: [f64; 3],
}

/// The scaling of a prediction before it is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScaleMode {
    /// Not at all.
    None,
    /// By one factor.
    Global,
    /// By one factor per channel.
    Channel,
    /// By the median ratio of each channel.
    Median,
}

impl ScaleMode {
    /// Every mode, in the order of tables.
    pub const ALL: [Self; 4] = [Self::None, Self::Global, Self::Channel, Self::Median];

    /// As in row ids.
    pub fn id(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Global => "global",
            Self::Channel => "channel",
            Self::Median => "median",
        }
    }

    /// As reports name it.
    pub fn words(self) -> &'static str {
        match self {
            Self::None => "as is",
            Self::Global => "after one factor",
            Self::Channel => "after one factor per channel",
            Self::Median => "after the median ratio per channel",
        }
    }
}

impl Scale {
    /// The factors of a pair of three channels.
    pub fn fit(pair: &Pair) -> Result<Self, MetricError> {
        if pair.truth.channels != 3 {
            let found = pair.truth.channels;
            return Err(MetricError::Channels { metric: "a scale", expected: "3", found });
        }
        let none = || MetricError::NoScale { region: pair.region.name().to_owned() };
        let products = Quantity::Projection.measure(pair, "a scale")?;
        let positive = |k: Option<f64>| k.filter(|k| *k > 0.0).ok_or_else(none);
        let mut scale = Self {
            global: positive(Statistic::Ratio.value([products.as_slice()]))?,
            channel: [0.0; 3],
            median: [0.0; 3],
        };
        for channel in 0..3 {
            let values: Vec<(f64, f64)> = (pair.region.pixels().iter())
                .filter_map(|i| pair.predicted(*i).zip(pair.true_values(*i)).nth(channel))
                .collect();
            let products: Vec<f64> = values.iter().flat_map(|(p, g)| [p * g, p * p]).collect();
            let ratios: Vec<f64> =
                values.iter().filter(|(p, _)| *p > 0.0).map(|(p, g)| g / p).collect();
            scale.channel[channel] = positive(Statistic::Ratio.value([products.as_slice()]))?;
            scale.median[channel] = positive(Statistic::Quantile(0.5).value([ratios.as_slice()]))?;
        }
        Ok(scale)
    }

    /// The factor of each channel.
    pub fn factors(&self, mode: ScaleMode) -> [f64; 3] {
        match mode {
            ScaleMode::None => [1.0; 3],
            ScaleMode::Global => [self.global; 3],
            ScaleMode::Channel => self.channel,
            ScaleMode::Median => self.median,
        }
    }
}
