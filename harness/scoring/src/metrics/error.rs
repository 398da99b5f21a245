//! Reasons why a metric has no value.

/// An error of a metric; each message is one line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MetricError {
    /// There is nothing to average over.
    #[error("region {region} is empty; give a mask with foreground that survives the erosion")]
    EmptyRegion {
        /// The region's name.
        region: String,
    },
    /// Two pictures that must agree in size do not.
    #[error(
        "{what} is {found_width}x{found_height}, the truth {width}x{height}; resample it first"
    )]
    Size {
        /// The picture that differs.
        what: &'static str,
        /// The columns.
        found_width: usize,
        /// The rows.
        found_height: usize,
        /// The truth's columns.
        width: usize,
        /// The truth's rows.
        height: usize,
    },
    /// A picture has another number of channels than the metric is defined for.
    #[error("{metric} takes {expected} channels, found {found}; give colours as R, G, B")]
    Channels {
        /// The metric's id.
        metric: &'static str,
        /// Channels it is defined for.
        expected: &'static str,
        /// Channels there are.
        found: usize,
    },
    /// A value inside the region is NaN or infinite, or a standard deviation is negative.
    #[error(
        "the {what} is {value} at column {x}, row {y}, channel {channel}; fix or mask the pixel"
    )]
    Value {
        /// The picture.
        what: &'static str,
        /// The value.
        value: f32,
        /// Column from the left.
        x: usize,
        /// Row from the top.
        y: usize,
        /// Channel index.
        channel: usize,
    },
    /// The prediction is zero wherever it is compared, so that no factor scales it to the truth.
    #[error("no factor fits in region {region}: the prediction is nowhere positive there")]
    NoScale {
        /// The region's name.
        region: String,
    },
    /// A metric lacks something that it compares with.
    #[error("{metric} needs {input}; give {argument}=")]
    Needs {
        /// The metric's id.
        metric: &'static str,
        /// Name of the missing input.
        input: &'static str,
        /// The argument that takes it.
        argument: &'static str,
    },
    /// A network computes it, which is not part of this program.
    #[error("{metric} is not computed here; call unshade.metrics.{metric}")]
    Elsewhere {
        /// The metric's id.
        metric: &'static str,
    },
    /// A metric that a user wrote is stated wrongly.
    #[error("metric {id:?}: {reason}")]
    Own {
        /// The id.
        id: String,
        /// The fault and its fix.
        reason: String,
    },
    /// No metric has this id.
    #[error("there is no metric {id:?}; there are {known}")]
    Unknown {
        /// The id asked for.
        id: String,
        /// The ids there are, comma separated.
        known: String,
    },
}
