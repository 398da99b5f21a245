//! The kernels of the steps, each timed alone.

use std::time::Duration;

use capture::Mesh;
use capture::rays::Occluder;
use glam::{Vec2, Vec3};
use solver::backend::Backend;
use solver::config::TransportConfig;
use solver::fit::adam::Adam;
use solver::memory::KeepFreedMemory;
use solver::model::blur::Blur;
use solver::model::normals::DirectionScale;
use solver::model::prior::albedo_prior;
use solver::model::pyramid::Pyramid;
use solver::transport::{Sky, Transport};

use super::cost::Cost;
use super::machine::{Reach, best};
use super::rows::{Floors, Kernel};
use super::synthetic::Problem;

/// Sizes of a kernel's inputs.
pub struct Size {
    /// Pixels of all views.
    pub pixels: usize,
    /// Side of the textures.
    pub texture: usize,
    /// Side of the transport's texture.
    pub transport: usize,
    /// Time for each kernel.
    pub budget: Duration,
}

/// Times every kernel of a processor that reaches `reach`.
pub fn measure(backend: &dyn Backend, reach: Reach, size: &Size) -> Vec<Kernel> {
    let _kept = KeepFreedMemory::begin();
    let Problem { config, samples, mut state } = Problem::new(size.pixels, size.texture);
    let mut kernels = vec![];
    let (pixels, texels) = (size.pixels as f64, (size.texture * size.texture) as f64);
    let mut time = |name, flops: f64, values: f64, work: &mut dyn FnMut()| {
        let milliseconds = 1e3 * best(size.budget, 2, work);
        let cost = Cost { flops, operations: flops, bytes: 4.0 * values };
        let (device, step) = (backend.name(), String::new());
        let floors = Floors::new(&cost, reach);
        kernels.push(Kernel { device, step, name, dispatches: 1.0, milliseconds, floors });
    };
    let taps = &samples.taps;
    let scale = DirectionScale::from(&config.networks);
    let networks = state.networks.clone();
    let albedo = state.albedo(&samples);
    let directions = scale.directions(&samples, None);
    let light = backend.light(&networks, &samples.position);

    time("networks: loss and gradients", 7488.0 * pixels, 22.0 * pixels, &mut || {
        backend.joint(&networks, &samples, &directions, &albedo);
    });
    time("networks: gradients by directions", 3456.0 * pixels, 30.0 * pixels, &mut || {
        backend.direction_gradient(&networks, &samples, &light, &directions, &albedo);
    });
    time("networks: light vector", 864.0 * pixels, 11.0 * pixels, &mut || {
        backend.light(&networks, &samples.position);
    });
    time("networks: shading", 1728.0 * pixels, 16.0 * pixels, &mut || {
        backend.shade(&networks, &light, &directions);
    });
    time("directions", 60.0 * pixels, 12.0 * pixels, &mut || {
        scale.directions(&samples, None);
    });
    let four = vec![0.5f32; 4 * size.texture * size.texture];
    time("texture sampling, 4 channels", 48.0 * pixels, 7.0 * pixels + 4.0 * texels, &mut || {
        taps.sample_vectors(&four);
    });
    time("gather, 4 channels", 48.0 * pixels, 7.0 * pixels + 4.0 * texels, &mut || {
        taps.gather_vectors(&albedo);
    });
    let mut gradient = vec![0.0f32; state.diffuse.len()];
    time("prior", 40.0 * 3.0 * texels, 3.0 * 3.0 * texels, &mut || {
        albedo_prior(&state.diffuse, size.texture, 0.3, &mut gradient);
    });
    let mut adam = Adam::new(&config.adam, 1e-3, state.diffuse.len());
    time("Adam, 3 channels", 14.0 * 3.0 * texels, 7.0 * 3.0 * texels, &mut || {
        adam.step(&mut state.diffuse, &gradient, 1.0, 0.0);
    });
    let sigma = config.fine_tuning.deviation_blur * size.texture as f32;
    let blur = Blur::new(size.texture, 3, sigma);
    let taps_of_blur = 2.0 * (3.0 * f64::from(sigma)).ceil() + 1.0;
    time("blur, 3 channels", 12.0 * taps_of_blur * texels, 6.0 * texels, &mut || {
        blur.apply(&state.deviation);
    });
    let pyramid = Pyramid::new(size.texture, sigma);
    let coarse = 0.25f64.powi(pyramid.levels() as i32);
    let operations = 16.0 * pyramid.taps() as f64 * coarse + 60.0 * (1.0 - coarse);
    time("blur by a pyramid, 4 channels", operations * texels, 8.0 * texels, &mut || {
        pyramid.apply(&four);
    });

    let (mesh, sky) = (bump(256), Sky::lat_long(16));
    let config =
        TransportConfig { texture_size: size.transport, bounces: 0, ..TransportConfig::default() };
    let transport = Transport::new(&mesh, &sky, &config, 0);
    let rows = size.transport * size.transport;
    let entries = (rows * sky.len()) as f64;
    let lights = vec![1.0f32; 3 * sky.len()];
    time("transport: shading", 6.0 * entries, entries, &mut || {
        transport.shading(&lights);
    });
    let shading = transport.shading(&lights);
    time("transport: gradient by the light", 6.0 * entries, entries, &mut || {
        transport.adjoint(&shading);
    });
    let occluder = Occluder::new(&mesh);
    let rays = sky.rays(8, 0);
    time("ray casts, one thread, per 32 768", 0.0, 0.0, &mut || {
        for ray in &rays {
            std::hint::black_box(occluder.first_hit(Vec3::new(0.3, 0.2, -1.0), ray.direction));
        }
    });
    kernels
}

/// A rough square of 2 `side`² triangles whose chart is the unit square.
fn bump(side: usize) -> Mesh {
    let at = |i: usize| i as f32 / side as f32;
    let place = |i: usize| Vec2::new(at(i % (side + 1)), at(i / (side + 1)));
    let uvs: Vec<Vec2> = (0..(side + 1) * (side + 1)).map(place).collect();
    let lift = |uv: &Vec2| 0.05 * (25.0 * uv.x).sin() * (20.0 * uv.y).cos();
    let point = |uv: &Vec2| Vec3::new(2.0 * uv.x - 1.0, 2.0 * uv.y - 1.0, lift(uv));
    let corner = |x: usize, y: usize| (y * (side + 1) + x) as u32;
    let square = |i: usize| {
        let (x, y) = (i % side, i / side);
        let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
        [[a, b, c], [a, c, d]]
    };
    Mesh {
        positions: uvs.iter().map(point).collect(),
        normals: vec![Vec3::Z; uvs.len()],
        triangles: (0..side * side).flat_map(square).collect(),
        uvs,
    }
}
