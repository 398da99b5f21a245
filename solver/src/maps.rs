//! Conversion of solved textures to maps.

use std::collections::BTreeMap;

use capture::gbuffer::Atlas;
use formats::fill;
use formats::maps::Maps;
use formats::picture::Picture;
use glam::Vec3;

use crate::model::texture::shrunk;
use crate::scene::Scene;

/// The maps that a stage changed, at most 256 texels a side, normalised like the final ones.
#[derive(Clone, Debug, PartialEq)]
pub struct StageMaps {
    /// The stage's name.
    pub stage: String,
    /// The maps that the stage changed.
    pub maps: Maps,
}

/// Fills unseen texels with the values of the nearest seen ones.
pub(crate) fn fill_unseen(texture: Vec<f32>, channels: usize, seen: &[bool]) -> Vec<f32> {
    let size = seen.len().isqrt();
    let mut picture = square(texture, channels, size);
    fill::fill_from_nearest(&mut picture, seen);
    picture.data
}

/// A square picture.
pub(crate) fn square(data: Vec<f32>, channels: usize, size: usize) -> Picture {
    Picture { width: size, height: size, channels, data }
}

/// A texture times a factor.
pub(crate) fn scaled(texture: &[f32], factor: f32) -> Vec<f32> {
    texture.iter().map(|value| value * factor).collect()
}

/// The mesh normals of an atlas with a deviation, x, y, z per texel.
pub(crate) fn bent_normals(atlas: &Atlas, deviation: &[f32]) -> Vec<f32> {
    let normals = atlas.normals.iter().zip(deviation.chunks_exact(3));
    normals.flat_map(|(n, d)| (n + Vec3::from_slice(d)).normalize().to_array()).collect()
}

/// Factors from the solved albedos to reflectances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scales {
    pub diffuse: f32,
    pub specular: f32,
}

/// The textures after a stage, small, for the record.
#[derive(Default)]
pub(crate) struct Snapshot {
    stage: String,
    diffuse: Option<Small>,
    specular: Option<Small>,
    deviation: Option<Small>,
}

/// Largest side of a snapshot, texels.
const SIDE: usize = 256;

struct Small {
    size: usize,
    texture: Vec<f32>,
}

impl Small {
    fn of(texture: &[f32], channels: usize, size: usize) -> Self {
        let side = size.min(SIDE);
        Self { size: side, texture: shrunk(texture, size, channels, side) }
    }
}

impl Snapshot {
    /// The snapshot of a stage, without textures yet.
    pub fn new(stage: &str) -> Self {
        Self { stage: stage.to_owned(), ..Self::default() }
    }

    /// Adds a diffuse albedo of side `size`.
    pub fn diffuse(self, texture: &[f32], size: usize) -> Self {
        Self { diffuse: Some(Small::of(texture, 3, size)), ..self }
    }

    /// Adds a specular albedo of side `size`.
    pub fn specular(self, texture: &[f32], size: usize) -> Self {
        Self { specular: Some(Small::of(texture, 1, size)), ..self }
    }

    /// Adds a deviation of the specular normal of side `size`.
    pub fn deviation(self, texture: &[f32], size: usize) -> Self {
        Self { deviation: Some(Small::of(texture, 3, size)), ..self }
    }
}

/// The snapshots as maps, with the final factors.
pub(crate) fn stage_maps(
    snapshots: Vec<Snapshot>,
    scales: Scales,
    scene: &Scene,
) -> Vec<StageMaps> {
    let mut charts: BTreeMap<usize, (Atlas, Vec<bool>)> = BTreeMap::new();
    let mut map =
        |small: Option<Small>, channels: usize, values: &dyn Fn(&Atlas, &[f32]) -> Vec<f32>| {
            let Small { size, texture } = small?;
            let (atlas, seen) = charts.entry(size).or_insert_with(|| {
                let atlas = Atlas::new(&scene.capture.mesh, size);
                let seen = scene.seen(&atlas);
                (atlas, seen)
            });
            let filled = fill_unseen(texture, channels, seen);
            Some(square(values(atlas, &filled), channels, size))
        };
    let stages = snapshots.into_iter().map(|snapshot| StageMaps {
        maps: Maps {
            diffuse_albedo: map(snapshot.diffuse, 3, &|_, texture| scaled(texture, scales.diffuse)),
            specular_albedo: map(snapshot.specular, 1, &|_, texture| {
                scaled(texture, scales.specular)
            }),
            specular_normal: map(snapshot.deviation, 3, &bent_normals),
            ..Maps::default()
        },
        stage: snapshot.stage,
    });
    stages.collect()
}
