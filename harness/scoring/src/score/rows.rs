//! From pairs of pictures to rows of the scores.

use std::collections::{BTreeMap, HashMap};

use formats::cancel;
use rayon::prelude::*;

use super::ScoreError;
use super::scores::Row;
use crate::metrics::{Metric, MetricError, Pair, Quantity, Sample, block_side, measured};

/// Fields that the rows of one comparison share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heading<'a> {
    pub subject: &'a str,
    pub light: Option<&'a str>,
    pub scale: &'a str,
    pub label: Option<&'a str>,
}

/// A pair, and the frame that it shows (none for maps).
pub(super) struct Compared<'a> {
    pub frame: Option<&'a str>,
    pub pair: Pair<'a>,
}

/// Quantities that rendering noise alone would give, per pixel of all frames.
pub(super) type Floors = HashMap<Quantity, Vec<f64>>;

/// One row per metric, pooled over the pairs.
pub(super) fn rows(
    heading: Heading,
    metrics: &[&str],
    compared: &[Compared],
    floors: &Floors,
) -> Result<Vec<Row>, ScoreError> {
    let wrong = ScoreError::of(heading.subject);
    let metrics: Vec<&'static Metric> =
        metrics.iter().map(|id| Metric::find(id)).collect::<Result<_, _>>().map_err(&wrong)?;
    let measured = measured(&metrics, |metric| sample(metric, compared)).map_err(&wrong)?;
    let row = |metric: &&'static Metric| {
        let floor = floors.get(&metric.quantity);
        row(heading, metric, compared, &measured[&metric.quantity], floor.map(Vec::as_slice))
    };
    Ok(metrics.par_iter().map(row).collect())
}

/// Blocks of one row, pooled over the frames: white errors ask for tens of thousands, which make an interval no
/// better and the bootstrap ten times as slow.
const MOST_BLOCKS: f64 = 2048.0;

/// The values of every pair in blocks of one side, the largest that one of them asks for.
fn sample(metric: &Metric, compared: &[Compared]) -> Result<(usize, Vec<Sample>), MetricError> {
    let values: Vec<Vec<f64>> =
        compared.iter().map(|compared| metric.measure(&compared.pair)).collect::<Result<_, _>>()?;
    let arity = metric.statistic.arity();
    let regions = compared.iter().map(|compared| compared.pair.region());
    let sides =
        values.iter().zip(regions).map(|(values, region)| block_side(values, arity, region));
    let pixels: usize = compared.iter().map(|compared| compared.pair.region().pixels().len()).sum();
    let side = sides.max().unwrap_or(1).max((pixels as f64 / MOST_BLOCKS).sqrt().ceil() as usize);
    let in_blocks = |(compared, values): (&Compared, Vec<f64>)| Sample {
        values,
        blocks: compared.pair.region().blocks(side).collect(),
    };
    Ok((side, compared.iter().zip(values).map(in_blocks).collect()))
}

fn row(
    heading: Heading,
    metric: &Metric,
    compared: &[Compared],
    (block, samples): &(usize, Vec<Sample>),
    floor: Option<&[f64]>,
) -> Row {
    cancel::check();
    let statistic = metric.statistic;
    let owned = |text: Option<&str>| text.map(str::to_owned);
    let per_frame: BTreeMap<String, f64> = compared
        .iter()
        .zip(samples)
        .filter_map(|(compared, sample)| {
            Some((compared.frame?.to_owned(), statistic.value([sample.values.as_slice()])?))
        })
        .collect();
    Row {
        subject: heading.subject.to_owned(),
        metric: metric.id.to_owned(),
        scale: heading.scale.to_owned(),
        region: compared.first().map_or("", |first| first.pair.region().name()).to_owned(),
        label: owned(heading.label),
        light: owned(heading.light),
        value: statistic.value(samples.iter().map(|sample| sample.values.as_slice())),
        ci95: statistic.interval(samples),
        block: Some(*block),
        n: samples.iter().map(|sample| sample.blocks.len() as u64).sum(),
        floor: floor.and_then(|floor| statistic.value([floor])),
        per_frame,
    }
}
