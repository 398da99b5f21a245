//! Metrics: pure functions of a prediction, its truth and a region.
//!
//! ```
//! use scoring::metrics::{Metric, Pair, Region};
//! use formats::picture::Picture;
//!
//! let truth = Picture { width: 2, height: 1, channels: 3, data: vec![0.5; 6] };
//! let prediction = Picture { data: vec![0.4; 6], ..truth.clone() };
//! let region = Region::whole(2, 1)?;
//! let pair = Pair::new(&prediction, &truth, &region)?;
//! let psnr = Metric::find("psnr_lin")?.value(&pair)?;
//! assert!((psnr.unwrap() - 20.0).abs() < 1e-5);
//! # Ok::<(), scoring::metrics::MetricError>(())
//! ```

mod colour;
mod compatible;
mod correlation;
mod deviation;
mod error;
mod filter;
mod measured;
mod neighbourhood;
mod own;
mod pair;
mod quantity;
mod rank;
mod region;
mod registry;
mod resample;
mod scale;
mod shared;
mod statistic;

pub use colour::{ciede2000, lab, luminance, srgb, typology_angle};
pub use compatible::Protocol;
pub use correlation::block_side;
pub use error::MetricError;
pub use filter::gaussian;
pub use measured::measured;
pub use own::OwnMetric;
pub use pair::Pair;
pub use quantity::{Quantity, RELATIVE_OFFSET};
pub use rank::upper_half;
pub use region::{Region, black_outside};
pub(crate) use registry::scored;
pub use registry::{Direction, METRICS, Metric};
pub use resample::resample;
pub use scale::{Scale, ScaleMode};
pub use statistic::{Sample, Statistic};
