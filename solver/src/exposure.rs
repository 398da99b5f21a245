//! Exposure and white balance of every view, where they are unknown: auto-exposure of a phone's video.
//!
//! Under a light that stands still, a diffuse surface point has one radiance in all views. So the logarithm of a channel
//! is a constant of the point plus a constant of the view, the logarithm of its gain:
//!
//! ```text
//! log picture(point, view) = radiance(point) + gain(view)
//! ```
//!
//! Both are fitted by least squares with Tukey's weights, which reject highlights and errors of registration. The gauge
//! is a mean of 0 of the logarithms over the views: the exposure of the capture is the geometric mean of theirs.
//!
//! Highlights move with the view, and add a few percent of the diffuse radiance everywhere. So a solve estimates the gains
//! twice: from the pictures, then without the highlights that a fast solve of the evened pictures predicts.

use std::borrow::Cow;

use capture::gbuffer::{Atlas, GBuffer};
use capture::projection::{Projection, per_texel};
use capture::{Capture, Mesh, View};
use formats::picture::Picture;

use crate::run::error::SolveError;

/// Side of the texture of points, texels.
const SIZE: usize = 192;
/// Longest side to which pictures are averaged, pixels: about as fine as the texture.
const PIXELS: usize = 400;
/// Cosine between view and normal from which an observation counts: grazing views reflect more.
const MIN_COSINE: f32 = 0.5;
/// Share of a view's median below which a channel is left out: highlights are a larger share of what is dark.
const DARK: f64 = 0.5;
/// Tukey's constant: 95 % efficiency for Gaussian errors.
const TUKEY: f64 = 4.685;
/// Rounds of reweighting.
const ROUNDS: usize = 30;
/// Points that a view must share with the other views.
const MIN_SHARED: usize = 20;

/// The factor (R, G, B) of a view's picture.
pub type Gain = [f32; 3];
/// The name and the gain of every training view.
pub type NamedGains = Vec<(String, Gain)>;

/// The capture with evenly exposed pictures, and the name and gain of every training view: those of `capture` and none
/// unless its exposures are unknown.
pub fn evened(capture: &Capture) -> Result<(Cow<'_, Capture>, NamedGains), SolveError> {
    if !capture.has_unknown_exposure {
        return Ok((Cow::Borrowed(capture), vec![]));
    }
    let views: Vec<View> = capture.train.iter().map(small).collect();
    let gains = solve(&capture.mesh, &views)?;
    Ok((Cow::Owned(divided(capture, &capture.train, &gains)), named(capture, &gains)))
}

/// [`evened`] with gains that are estimated again without the highlights (R, G, B) that `highlights_of` predicts for every
/// training view of a capture with small, evened pictures.
pub(crate) fn evened_without_highlights<'a>(
    capture: &'a Capture,
    highlights_of: impl FnOnce(&Capture) -> Result<Vec<Picture>, SolveError>,
) -> Result<(Cow<'a, Capture>, NamedGains), SolveError> {
    if !capture.has_unknown_exposure {
        return Ok((Cow::Borrowed(capture), vec![]));
    }
    let views: Vec<View> = capture.train.iter().map(small).collect();
    let mut gains = solve(&capture.mesh, &views)?;
    let mut even = divided(capture, &views, &gains);
    let highlights = highlights_of(&even)?;
    for (view, highlights) in even.train.iter_mut().zip(&highlights) {
        let values = view.image.data.iter_mut().zip(&highlights.data);
        values.for_each(|(value, highlight)| *value -= highlight);
    }
    for (gain, rest) in gains.iter_mut().zip(solve(&capture.mesh, &even.train)?) {
        gain.iter_mut().zip(rest).for_each(|(gain, rest)| *gain *= rest);
    }
    Ok((Cow::Owned(divided(capture, &capture.train, &gains)), named(capture, &gains)))
}

/// The capture with `views`, divided by their gains, in the place of its training views.
fn divided(capture: &Capture, views: &[View], gains: &[Gain]) -> Capture {
    let mut even = capture.clone();
    even.train = views.to_vec();
    even.has_unknown_exposure = false;
    for (view, gain) in even.train.iter_mut().zip(gains) {
        for pixel in view.image.data.chunks_exact_mut(3) {
            pixel.iter_mut().zip(gain).for_each(|(value, gain)| *value /= gain);
        }
    }
    even
}

fn named(capture: &Capture, gains: &[Gain]) -> NamedGains {
    let names = capture.train.iter().map(|view| view.camera.name.clone());
    names.zip(gains.iter().copied()).collect()
}

/// A point in a view: the view, and the logarithm of a channel.
type Look = (usize, f64);

fn solve(mesh: &Mesh, views: &[View]) -> Result<Vec<Gain>, SolveError> {
    let gbuffers = GBuffer::of_views(mesh, views);
    let projections = Projection::of_views(views, &gbuffers);
    let atlas = Atlas::new(mesh, SIZE);
    let looks: Vec<Vec<(usize, [f32; 3])>> = per_texel(&atlas, &projections, |seen| {
        let steep = seen.iter().filter(|(_, seen)| seen.cosine >= MIN_COSINE);
        steep.map(|(view, seen)| (*view, projections[*view].colour(seen).to_array())).collect()
    });
    let mut gains = vec![[1.0; 3]; views.len()];
    for channel in 0..3 {
        let points = logarithms(&looks, views.len(), channel);
        for (view, count) in shared(&points, views.len()).into_iter().enumerate() {
            if count < MIN_SHARED {
                return Err(SolveError::Exposure(views[view].camera.name.clone()));
            }
        }
        for (gain, logarithm) in gains.iter_mut().zip(fit(&points, views.len())) {
            gain[channel] = logarithm.exp() as f32;
        }
    }
    Ok(gains)
}

/// The view, averaged over 2 x 2 pixels until it is small.
fn small(view: &View) -> View {
    let mut view = view.clone();
    while view.camera.width.max(view.camera.height) > PIXELS {
        view = view.half();
    }
    view
}

/// The logarithms of a channel of all points that several views show, but for what is dark.
fn logarithms(looks: &[Vec<(usize, [f32; 3])>], views: usize, channel: usize) -> Vec<Vec<Look>> {
    let mut of_view = vec![vec![]; views];
    for (view, colour) in looks.iter().flatten() {
        of_view[*view].push(f64::from(colour[channel]));
    }
    let dark: Vec<f64> = of_view.iter_mut().map(|values| DARK * median(values)).collect();
    let bright = |(view, colour): &(usize, [f32; 3])| {
        let value = f64::from(colour[channel]);
        (value > dark[*view] && value > 0.0).then(|| (*view, value.ln()))
    };
    let points = looks.iter().map(|looks| looks.iter().filter_map(bright).collect::<Vec<_>>());
    points.filter(|looks| looks.len() > 1).collect()
}

/// The number of points of every view that the largest set of views with common points shares.
fn shared(points: &[Vec<Look>], views: usize) -> Vec<usize> {
    let mut above: Vec<usize> = (0..views).collect();
    let mut together = vec![0; views * views];
    for looks in points {
        for pair in looks.windows(2) {
            together[pair[0].0 * views + pair[1].0] += 1;
        }
    }
    for (at, count) in together.iter().enumerate() {
        if *count >= MIN_SHARED {
            let (a, b) = (root(&above, at / views), root(&above, at % views));
            above[a.max(b)] = a.min(b);
        }
    }
    let sets: Vec<usize> = (0..views).map(|view| root(&above, view)).collect();
    let size = |set: usize| sets.iter().filter(|other| **other == set).count();
    let largest = (0..views).max_by_key(|set| (size(*set), views - set)).unwrap_or(0);
    let mut counts = vec![0; views];
    for (view, _) in points.iter().flatten() {
        if sets[*view] == largest {
            counts[*view] += 1;
        }
    }
    counts
}

fn root(above: &[usize], mut view: usize) -> usize {
    while above[view] != view {
        view = above[view];
    }
    view
}

/// The logarithm of every view's gain, with a mean of 0.
fn fit(points: &[Vec<Look>], views: usize) -> Vec<f64> {
    let mut weights: Vec<Vec<f64>> = points.iter().map(|looks| vec![1.0; looks.len()]).collect();
    let mut gains = vec![0.0; views];
    for _ in 0..ROUNDS {
        gains = least_squares(points, &weights, views);
        let residuals: Vec<Vec<f64>> = points
            .iter()
            .map(|looks| {
                let values: Vec<f64> = looks.iter().map(|(view, y)| y - gains[*view]).collect();
                // The median over the views does not follow a highlight in one of them.
                let middle = median(&mut values.clone());
                values.into_iter().map(|value| value - middle).collect()
            })
            .collect();
        let mut sizes: Vec<f64> = residuals.iter().flatten().map(|value| value.abs()).collect();
        let limit = TUKEY * 1.4826 * median(&mut sizes) + 1e-6;
        // Never 0: every view keeps its place in the equations.
        let weight = |value: &f64| (1.0 - (value / limit).powi(2).min(1.0)).powi(2) + 1e-6;
        weights = residuals.iter().map(|values| values.iter().map(weight).collect()).collect();
    }
    gains
}

/// The gains of weighted least squares; the constants of the points are eliminated.
fn least_squares(points: &[Vec<Look>], weights: &[Vec<f64>], views: usize) -> Vec<f64> {
    let mut matrix = vec![0.0; views * views];
    let mut side = vec![0.0; views];
    for (looks, weights) in points.iter().zip(weights) {
        let total: f64 = weights.iter().sum();
        let mean = looks.iter().zip(weights).map(|((_, y), w)| w * y).sum::<f64>() / total;
        for ((view, y), w) in looks.iter().zip(weights) {
            matrix[view * views + view] += w;
            side[*view] += w * (y - mean);
            for ((other, _), v) in looks.iter().zip(weights) {
                matrix[view * views + other] -= w * v / total;
            }
        }
    }
    // The gauge: the equations leave the mean free.
    let scale =
        (0..views).map(|view| matrix[view * views + view]).sum::<f64>() / (views * views) as f64;
    matrix.iter_mut().for_each(|value| *value += scale);
    cholesky(&mut matrix, &mut side, views);
    side
}

/// Solves a symmetric positive definite system in place.
fn cholesky(matrix: &mut [f64], side: &mut [f64], size: usize) {
    for row in 0..size {
        for column in 0..=row {
            let dot: f64 =
                (0..column).map(|k| matrix[row * size + k] * matrix[column * size + k]).sum();
            let value = matrix[row * size + column] - dot;
            matrix[row * size + column] = match row == column {
                true => value.max(1e-12).sqrt(),
                false => value / matrix[column * size + column],
            };
        }
        let dot: f64 = (0..row).map(|k| matrix[row * size + k] * side[k]).sum();
        side[row] = (side[row] - dot) / matrix[row * size + row];
    }
    for row in (0..size).rev() {
        let dot: f64 = (row + 1..size).map(|k| matrix[k * size + row] * side[k]).sum();
        side[row] = (side[row] - dot) / matrix[row * size + row];
    }
}

/// The median; 0 of nothing. Reorders the values.
fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests;
