//! Passes through textures, against separate passes with planes between them.

use solver::backend::cpu::Cpu;
use solver::backend::{Backend, JointGradient, TexturedNormals};
use solver::config::PaperConfig;
use solver::fit::Fit;
use solver::model::deviation::Deviation;
use solver::model::deviation_textures::ROWS;
use solver::model::networks::Networks;
use solver::model::normals::DirectionScale;
use solver::model::planes::Planes;
use solver::model::samples::Samples;
use solver::model::texture::interleave;
use solver::paper::fields::ShadingFields;
use solver::paper::normals::Normals;

use super::scene::problem;
use super::testing;

/// A backend without textured passes.
struct ByPlanes<'a>(&'a dyn Backend);

impl Backend for ByPlanes<'_> {
    fn name(&self) -> String {
        self.0.name()
    }

    fn joint(&self, n: &Networks, s: &Samples, d: &Planes, a: &Planes) -> JointGradient {
        self.0.joint(n, s, d, a)
    }

    fn light(&self, n: &Networks, p: &Planes) -> Planes {
        self.0.light(n, p)
    }

    fn direction_gradient(
        &self,
        n: &Networks,
        s: &Samples,
        l: &Planes,
        d: &Planes,
        a: &Planes,
    ) -> (f64, Planes) {
        self.0.direction_gradient(n, s, l, d, a)
    }

    fn shade(&self, n: &Networks, l: &Planes, d: &Planes) -> Planes {
        self.0.shade(n, l, d)
    }
}

/// Loss and gradients of the warm-up.
pub fn joint(backend: &dyn Backend) {
    let config = PaperConfig::default();
    let (samples, ShadingFields { networks, diffuse, specular, .. }) = problem(&config);
    let directions = DirectionScale::from(&config.networks).directions(&samples, None);
    let albedo = interleave::<4>(&[(&diffuse, 3), (&specular, 1)]);
    let [fused, split] = [backend, &ByPlanes(backend)]
        .map(|backend| backend.joint_textures(&networks, &samples, &directions, &albedo));
    assert!((fused.loss / split.loss - 1.0).abs() < 1e-6, "{} {}", fused.loss, split.loss);
    for (got, expected) in [(fused.networks, split.networks), (fused.albedo, split.albedo)] {
        let size = expected.iter().fold(0.0f32, |m, g| m.max(g.abs()));
        assert!(size > 0.0 && got.len() == expected.len());
        for (at, (got, expected)) in got.iter().zip(&expected).enumerate() {
            assert!((got - expected).abs() < 1e-5 * size, "{at}: {got} {expected}");
        }
    }
}

/// Loss and gradients of a bent dome, with a narrow and a wide blur; unseen texels have no gradient.
pub fn normals(backend: &dyn Backend) {
    for blur in [0.05, 0.14] {
        let mut config = PaperConfig::default();
        config.fine_tuning.deviation_blur = blur;
        let (samples, state) = problem(&config);
        let deviation = Deviation::new(&config, state.size);
        let t: Vec<f32> =
            (0..state.deviation.len()).map(|i| 0.4 * (i as f32 * 0.37).sin()).collect();
        let textured = TexturedNormals {
            networks: &state.networks,
            samples: &samples,
            light: &backend.light(&state.networks, &samples.position),
            albedo: &state.albedo(&samples),
            scale: &deviation.scale,
            textures: &deviation.packed(&t, &state.specular),
        };
        let [fused, split] =
            [backend, &ByPlanes(backend)].map(|backend| backend.deviation_gradient(&textured));
        assert!((fused.0 / split.0 - 1.0).abs() < 1e-6, "{} {}", fused.0, split.0);
        let size = split.1.iter().fold(0.0f32, |m, g| m.max(g.abs()));
        assert!(size > 0.0 && size < 1.0 && fused.1.len() == split.1.len());
        for (at, (got, expected)) in fused.1.iter().zip(&split.1).enumerate() {
            assert!((got - expected).abs() < 1e-5 * size, "{at}: {got} {expected}");
        }
        let mut seen = vec![false; state.size * state.size];
        for cell in samples.taps.cells() {
            let at = *cell as usize;
            [at, at + 1, at + state.size, at + state.size + 1]
                .iter()
                .for_each(|at| seen[*at] = true);
        }
        for (gradient, seen) in fused.1.chunks_exact(ROWS).zip(seen) {
            assert!(seen || gradient.iter().all(|value| *value == 0.0));
        }
    }
}

/// Steps of the normals on any number of threads, and after a stop, to the same bits.
pub fn steps() {
    for blur in [0.05, 0.14, 0.27] {
        let mut config = PaperConfig::default();
        config.fine_tuning.deviation_blur = blur;
        let (samples, start) = problem(&config);
        let deviation = Deviation::new(&config, start.size);
        let run = |stop: usize| {
            let cpu = Cpu::new();
            let stage = || Normals::new(&config, &samples, &deviation, &start, &cpu);
            let mut first = stage();
            let mut losses: Vec<_> = (0..stop).map(|_| first.step(&cpu, 1.0)).collect();
            // The values that another process would read.
            let mut second = stage();
            for (to, from) in second.variables().into_iter().zip(first.variables()) {
                to.values.clone_from(from.values);
                to.adam.clone_from(from.adam);
            }
            losses.extend((stop..6).map(|_| second.step(&cpu, 1.0)));
            (losses, second.relief)
        };
        let once = testing::on_threads(1, || run(6));
        assert!(once.0[5] < once.0[0]);
        for (threads, stop) in [(2, 6), (3, 2)] {
            assert!(testing::on_threads(threads, || run(stop)) == once, "{blur} {threads}");
        }
    }
}
