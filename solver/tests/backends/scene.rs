//! A small scene with a known solution.

use std::path::Path;

use capture::gbuffer::GBuffer;
use capture::{Capture, View};
use glam::Vec3;
use solver::Config;
use solver::config::{PaperConfig, TextureSize};
use solver::model::networks::Networks;
use solver::model::samples::Samples;
use solver::paper::fields::ShadingFields;
use solver::paper::sample_space;

use super::testing;

/// Side of the textures of [`problem`].
const SIDE: usize = 32;

/// The unit dome of two paints under one soft light.
fn lit(position: Vec3) -> (Vec3, u8) {
    let inner = position.truncate().length() < 0.4;
    let albedo = if inner { Vec3::new(0.6, 0.4, 0.3) } else { Vec3::new(0.3, 0.2, 0.15) };
    let light = Vec3::new(0.4, 0.5, 0.77).normalize();
    (albedo * (0.25 + 0.75 * position.dot(light).max(0.0)), 1 + u8::from(inner))
}

fn views(count: usize, size: usize) -> Vec<View> {
    let mesh = testing::dome(24);
    testing::rig(count, size).iter().map(|camera| testing::view(&mesh, camera, lit)).collect()
}

/// Samples of some views, and an initial state: a few thousand samples, not a whole number of blocks.
pub fn problem(config: &PaperConfig) -> (Samples, ShadingFields) {
    let mesh = testing::dome(24);
    let views = views(3, 64);
    let gbuffers = GBuffer::of_views(&mesh, &views);
    let space = sample_space(&mesh, config);
    let samples = space.training(&views, &gbuffers, config.depth_weights(), SIDE);
    assert!(samples.len() > 4000 && !samples.len().is_multiple_of(256), "{}", samples.len());
    let texels = SIDE * SIDE;
    let fields = ShadingFields {
        networks: Networks::new(&config.networks, 2),
        size: SIDE,
        diffuse: (0..3 * texels).map(|i| 0.3 + 0.1 * (i as f32 * 12.9898).sin()).collect(),
        specular: (0..texels).map(|i| 0.03 + 0.01 * (i as f32 * 78.233).sin()).collect(),
        deviation: vec![0.0; 3 * texels],
    };
    (samples, fields)
}

/// A capture folder with five training views and one withheld.
pub fn capture(folder: &Path) -> Capture {
    testing::write_capture(folder, &testing::dome(24), &views(6, 48), 1);
    Capture::open(folder).unwrap()
}

/// The default method with all stages in seconds.
pub fn short() -> Config {
    Config::from_toml(include_str!("../small.toml")).unwrap()
}

/// The published method with few steps.
pub fn short_paper() -> PaperConfig {
    let mut config = PaperConfig::default();
    config.rendering.positive_albedo = true;
    config.warm_up.iterations = 60;
    config.warm_up.texture_size = 64;
    config.fine_tuning.iterations = 40;
    config.fine_tuning.rounds = 1;
    config.fine_tuning.texture_size = TextureSize::Side(64);
    config
}
