//! The observability of every texel in a capture: how many views see it and how obliquely, how much light it gets,
//! how much of that the face itself blocks, and how many of its pictures are clipped.

use std::fs;
use std::path::Path;

use capture::Capture;
use capture::gbuffer::{Atlas, GBuffer};
use capture::projection::{Observation, Projection, per_texel};
use formats::picture::{self, GrayImage, Picture};

use super::ScoreError;
use super::cast_shadow::cast_shadow;
use super::geometry::Geometry;
use super::light_cells::{CellLight, RowsAt};
use super::truth::{self, Truth};
use crate::metrics::{luminance, resample};

/// Side of the chart on which cast shadows are found, texels.
const SHADOW_SIDE: usize = 128;
/// A value this near below the white level is clipped: codes and halves are rounded.
const CLIPPED: f32 = 0.999;

/// Maps of one channel, of the truth's size; what they say is of the texels that scores compare. Views are those of
/// the truth; all else is by the mesh and the cameras that a capture states.
pub struct Observability {
    /// 255 where scores compare texels, else 0.
    pub compared: GrayImage,
    /// Training views that see the texel.
    pub views: Picture,
    /// The least angle between the mesh's normal and a view that sees the texel, degrees; 90 where none does.
    pub obliqueness: Picture,
    /// Luminance of the true diffuse shading over its median.
    pub light: Picture,
    /// The share of the irradiance that the mesh blocks, 0 to 1, as if the light came from infinitely far. None without
    /// `truth/light.exr`.
    pub cast_shadow: Option<Picture>,
    /// The share, 0 to 1, of the views of the texel in which a channel is clipped; NaN where none sees it. None if
    /// pictures have no white level.
    pub saturation: Option<Picture>,
}

impl Observability {
    /// Computes the observability of a rendered capture.
    ///
    /// # Errors
    /// If the capture or its truth lacks a file, or one of them is broken.
    pub fn of(folder: &Path) -> Result<Self, ScoreError> {
        let truth = Truth::open(folder)?;
        let capture = Capture::reopen(folder)?;
        let side = truth.diffuse_albedo.width;
        let map = |data: Vec<f32>| Picture { width: side, height: side, channels: 1, data };
        let atlas = Atlas::new(&capture.mesh, side);
        let gbuffers = GBuffer::of_views(&capture.mesh, &capture.train);
        let projections = Projection::of_views(&capture.train, &gbuffers);
        let least_angle = |seen: &[(usize, Observation)]| {
            let cosine = seen.iter().map(|(_, seen)| seen.cosine).fold(0.0, f32::max);
            Some(cosine.min(1.0).acos().to_degrees())
        };
        let angles = per_texel(&atlas, &projections, least_angle);
        let saturation = white_level(folder)?.map(|white| {
            let clipped = |(view, seen): &&(usize, Observation)| {
                projections[*view].colour(seen).max_element() >= CLIPPED * white
            };
            let share = |seen: &[(usize, Observation)]| {
                Some(seen.iter().filter(clipped).count() as f32 / seen.len() as f32)
            };
            let shares = per_texel(&atlas, &projections, share);
            map(shares.into_iter().map(|share| share.unwrap_or(f32::NAN)).collect())
        });
        let mut compared = GrayImage { width: side, height: side, data: vec![0; side * side] };
        truth.region.pixels().iter().for_each(|at| compared.data[*at] = 255);
        Ok(Self {
            views: map(truth.views.data.iter().map(|views| f32::from(*views)).collect()),
            obliqueness: map(angles.into_iter().map(|angle| angle.unwrap_or(90.0)).collect()),
            light: map(relative_light(
                &Geometry::of(folder, &truth)?.shading,
                truth.region.pixels(),
            )),
            cast_shadow: shadow(folder, &capture)?.map(|shadow| resample(&shadow, side, side)),
            saturation,
            compared,
        })
    }
}

/// Luminance of a shading over its median among `compared` texels.
fn relative_light(shading: &Picture, compared: &[usize]) -> Vec<f32> {
    let texels = shading.data.chunks_exact(3);
    let light: Vec<f64> =
        texels.map(|rgb| luminance(rgb.iter().map(|value| f64::from(*value)))).collect();
    let mut sorted: Vec<f64> = compared.iter().map(|at| light[*at]).collect();
    sorted.sort_by(f64::total_cmp);
    let median = sorted.get(sorted.len() / 2).copied().unwrap_or(1.0);
    light.into_iter().map(|light| (light / median) as f32).collect()
}

fn shadow(folder: &Path, capture: &Capture) -> Result<Option<Picture>, ScoreError> {
    let path = truth::folder(folder)?.join("light.exr");
    if !path.is_file() {
        return Ok(None);
    }
    let light = CellLight::of(&picture::read_exr_colour(&path, &["R", "G", "B"])?, RowsAt::Poles);
    let atlas = Atlas::new(&capture.mesh, SHADOW_SIDE);
    let data = cast_shadow(&capture.mesh, &atlas, &light);
    Ok(Some(Picture { width: SHADOW_SIDE, height: SHADOW_SIDE, channels: 1, data }))
}

/// The radiance at which the pictures clip; none if they do not.
fn white_level(folder: &Path) -> Result<Option<f32>, ScoreError> {
    let path = truth::present(truth::folder(folder)?.join("scene.toml"), truth::AGAIN)?;
    let text = fs::read_to_string(&path).map_err(|error| ScoreError::io(&path, error))?;
    let scene: toml::Table = text.parse().map_err(|error| ScoreError::text(&path, error))?;
    let number = |key: &str| {
        let value = scene.get("image_formation")?.get(key)?;
        value.as_float().or(value.as_integer().map(|whole| whole as f64))
    };
    let stops = number("exposure_stops").unwrap_or(0.0);
    Ok(number("white_level").map(|white| (white * 2_f64.powf(-stops)) as f32))
}
