//! Synthetic G-buffers of any size, so that a benchmark needs no capture.
//!
//! Every view sees the same bump of a surface through a turned square grid of pixels, so that
//! neighbouring pixels share texels as on a real chart, and views meet them in different places.

use glam::{Vec2, Vec3};
use solver::backend::Backend;
use solver::config::PaperConfig;
use solver::fit::Fit;
use solver::model::deviation::Deviation;
use solver::model::networks::Networks;
use solver::model::planes::Planes;
use solver::model::samples::Samples;
use solver::model::taps::Taps;
use solver::paper::diffuse::diffuse;
use solver::paper::fields::ShadingFields;
use solver::paper::normals::Normals;
use solver::paper::warm_up::WarmUp;
use solver::transport::skin::schlick;

use super::kind::Kind;

/// Views of every problem.
pub const VIEWS: usize = 10;
/// Side of the square of the chart that a view covers.
const COVERED: f32 = 0.8;

/// Starting point of an optimisation's stages.
pub struct Problem {
    /// The configuration `paper`.
    pub config: PaperConfig,
    /// Pixels of all views, in texel order.
    pub samples: Samples,
    /// Textures with some structure, and networks of seed 0.
    pub state: ShadingFields,
}

impl Problem {
    /// `pixels` in ten views, with textures of side `size`.
    pub fn new(pixels: usize, size: usize) -> Self {
        let per_view = pixels.div_ceil(VIEWS);
        let side = (per_view as f32).sqrt().ceil();
        let place = |i: usize| place(i % per_view, i / per_view, side);
        let uvs: Vec<Vec2> = (0..pixels).map(|i| place(i).0).collect();
        let (taps, order) = Taps::sorted(size, &uvs);
        drop(uvs);
        let at = |i: usize| pixel(place(order[i]));
        let config = paper();
        let f0 = config.skin.f0;
        let vector =
            |part: fn(&Pixel) -> Vec3| Planes::from_fn(pixels, |i| part(&at(i)).to_array());
        let samples = Samples {
            position: vector(|p| p.position),
            normal: vector(|p| p.normal),
            view: vector(|p| p.view),
            fresnel: Planes::from_fn(pixels, |i| [schlick(f0, at(i).normal.dot(at(i).view))]),
            target: vector(|p| p.colour),
            weight: Planes::from_fn(pixels, |_| [1.0]),
            pixel: order.iter().map(|i| (i % per_view) as u32).collect(),
            view_index: order.iter().map(|i| (i / per_view) as u32).collect(),
            taps,
        };
        let wave = |i: usize| 0.5 + 0.4 * (i as f32 * 0.37).sin();
        let texels = size * size;
        let state = ShadingFields {
            networks: Networks::new(&config.networks, 0),
            size,
            diffuse: (0..3 * texels).map(wave).collect(),
            specular: (0..texels).map(|i| 0.03 * wave(i)).collect(),
            deviation: vec![0.0; 3 * texels],
        };
        Self { config, samples, state }
    }

    /// The fit whose steps are timed; `deviation` has the side of the textures.
    pub fn fit<'a>(
        &'a self,
        kind: Kind,
        deviation: &'a Deviation,
        backend: &dyn Backend,
    ) -> Box<dyn Fit + 'a> {
        let Self { config, samples, state } = self;
        match kind {
            Kind::WarmUp => Box::new(WarmUp::new(config, samples, state.clone())),
            Kind::Normals => Box::new(Normals::new(config, samples, deviation, state, backend)),
            Kind::Diffuse => Box::new(diffuse(config, samples, deviation, state, backend)),
        }
    }
}

/// The configuration whose steps are timed.
pub fn paper() -> PaperConfig {
    PaperConfig::default()
}

/// A pixel of a synthetic G-buffer.
struct Pixel {
    position: Vec3,
    normal: Vec3,
    view: Vec3,
    colour: Vec3,
}

/// The place of pixel `i` of a view's grid of side `side` on the chart, and the turn of the view.
fn place(i: usize, view: usize, side: f32) -> (Vec2, f32) {
    let (x, y) = (i as f32 % side, (i as f32 / side).floor());
    let local = (Vec2::new(x, y) + 0.5) / side - 0.5;
    let turn = (view as f32 + 0.5) / VIEWS as f32 - 0.5;
    (Vec2::splat(0.5) + COVERED * Vec2::from_angle(0.3 * turn).rotate(local), turn)
}

fn pixel((uv, turn): (Vec2, f32)) -> Pixel {
    let Vec2 { x, y } = 2.0 * uv - 1.0;
    let normal = Vec3::new(x, y, 1.0).normalize();
    let position = Vec3::new(x, y, -0.5 * (x * x + y * y));
    let view = (Vec3::new(2.0 * turn, 0.1, 3.0) - position).normalize();
    let light = Vec3::new(0.4, 0.5, 0.77);
    let shine = (view + light).normalize().dot(normal).max(0.0).powi(40);
    let tone = Vec3::new(0.6, 0.4, 0.3) * (1.0 + 0.3 * (40.0 * x).sin() * (30.0 * y).cos());
    let colour = tone * normal.dot(light).max(0.1) + 0.2 * shine;
    Pixel { position, normal, view, colour }
}
