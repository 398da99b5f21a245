//! The textures after a stage, small: for the record, nothing goes on from it.

use std::collections::BTreeMap;

use capture::Mesh;
use capture::gbuffer::Atlas;
use capture::projection::{Projection, per_texel};
use formats::fill;
use formats::maps::Maps;
use formats::picture::Picture;
use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::normalise::Scales;
use crate::model::texture::resample;
use crate::solution::StageMaps;

/// Largest side, texels.
const SIDE: usize = 256;

/// The factor that an albedo is multiplied with at the end.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) enum Unit {
    /// The factors of the networks' model.
    Networks,
    /// The factor of explicit transport.
    Transport,
}

/// The textures that a stage changed.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Snapshot {
    stage: String,
    unit: Unit,
    diffuse: Option<Small>,
    specular: Option<Small>,
    /// The deviation of the specular normal.
    deviation: Option<Small>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Small {
    size: usize,
    texture: Vec<f32>,
}

impl Small {
    fn of(texture: &[f32], channels: usize, size: usize) -> Self {
        let (mut texture, mut size) = (texture.to_vec(), size);
        // Halving averages 2 x 2 texels, a longer jump would leave texels out.
        while size > SIDE {
            let next = (size / 2).max(SIDE);
            texture = resample(&texture, size, channels, next);
            size = next;
        }
        Self { size, texture }
    }
}

impl Snapshot {
    /// The snapshot of a stage that has changed nothing yet.
    pub fn new(stage: &str, unit: Unit) -> Self {
        Self { stage: stage.to_owned(), unit, diffuse: None, specular: None, deviation: None }
    }

    /// With a diffuse albedo of side `size`.
    pub fn diffuse(self, texture: &[f32], size: usize) -> Self {
        Self { diffuse: Some(Small::of(texture, 3, size)), ..self }
    }

    /// With a specular albedo of side `size`.
    pub fn specular(self, texture: &[f32], size: usize) -> Self {
        Self { specular: Some(Small::of(texture, 1, size)), ..self }
    }

    /// With a deviation of the specular normal (after tanh) of side `size`.
    pub fn deviation(self, texture: &[f32], size: usize) -> Self {
        Self { deviation: Some(Small::of(texture, 3, size)), ..self }
    }
}

/// The chart at the size of a snapshot.
struct Chart {
    atlas: Atlas,
    seen: Vec<bool>,
}

/// The snapshots as maps, with the final factors.
pub(super) fn stage_maps(
    snapshots: Vec<Snapshot>,
    networks: Scales,
    transport: Option<f32>,
    mesh: &Mesh,
    projections: &[Projection],
) -> Vec<StageMaps> {
    let mut charts: BTreeMap<usize, Chart> = BTreeMap::new();
    let mut map = |small: Option<Small>, texel: &dyn Fn(&[f32], Vec3) -> Vec<f32>| {
        let Small { size, texture } = small?;
        let chart = charts.entry(size).or_insert_with(|| {
            let atlas = Atlas::new(mesh, size);
            let seen = per_texel(&atlas, projections, |_| true);
            Chart { atlas, seen }
        });
        let channels = texture.len() / (size * size);
        let mut picture = Picture { width: size, height: size, channels, data: texture };
        fill::fill_from_nearest(&mut picture, &chart.seen);
        let texels = picture.data.chunks_exact(channels).zip(&chart.atlas.normals);
        picture.data = texels.flat_map(|(value, normal)| texel(value, *normal)).collect();
        Some(picture)
    };
    let mut one = |snapshot: Snapshot| {
        let scales = match snapshot.unit {
            Unit::Networks => networks,
            Unit::Transport => {
                Scales { diffuse: transport.unwrap_or(networks.diffuse), ..networks }
            }
        };
        let by = |scale: f32| {
            move |value: &[f32], _: Vec3| value.iter().map(|value| value * scale).collect()
        };
        let normal = |value: &[f32], normal: Vec3| {
            (normal + Vec3::from_slice(value)).normalize().to_array().to_vec()
        };
        let maps = Maps {
            diffuse_albedo: map(snapshot.diffuse, &by(scales.diffuse)),
            specular_albedo: map(snapshot.specular, &by(scales.specular)),
            specular_normal: map(snapshot.deviation, &normal),
            ..Maps::default()
        };
        StageMaps { stage: snapshot.stage, maps }
    };
    snapshots.into_iter().map(&mut one).collect()
}
