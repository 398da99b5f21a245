//! The conjugate gradients of the height problem on a device, against an independent loop with the processor's
//! operators.

use capture::gbuffer::Atlas;
use solver::backend::Backend;
use solver::backend::resident::NormalEquations;
use solver::config::PaperConfig;
use solver::model::blur::Blur;
use solver::model::height::HeightField;
use solver::model::planes::Planes;

use super::model::noise;
use super::scene::problem;
use super::testing;

const SIDE: usize = 32;
const TEXELS: usize = SIDE * SIDE;
const STEPS: usize = 12;
/// The removed share of the component along the diffuse layer's colour.
const DIFFUSE_SHARE: f32 = 0.6;
/// Weights of flatness, smoothness, heights, albedo.
const WEIGHTS: [f32; 4] = [30.0, 60.0, 1e-3, 30.0];

fn channels(values: &[f32], first: usize) -> Vec<f32> {
    values.chunks_exact(9).flat_map(|texel| texel[first..first + 3].to_vec()).collect()
}

/// The product with the matrix.
fn product_with_matrix(equations: &NormalEquations, field: &HeightField, x: &[f32]) -> Vec<f32> {
    let [flatness, smoothness, height_damping, albedo_damping] = WEIGHTS;
    let deviation = field.deviation(&x[..TEXELS]);
    let soft = equations.blur.apply(&deviation);
    let texture: Vec<f32> = (0..TEXELS)
        .flat_map(|t| {
            let albedo = &x[TEXELS + 3 * t..][..3];
            let parts = [&deviation[3 * t..][..3], &soft[3 * t..][..3], albedo];
            parts.concat()
        })
        .collect();
    let q = equations.taps.sample::<9>(&texture);
    let by = Planes::from_fn::<9>(q.len(), |i| {
        let s: [f32; 15] = equations.slopes.sample(i, 0);
        let q: [f32; 9] = q.sample(i, 0);
        let row = |c: usize, k: usize| match k / 3 {
            0 => s[k],
            1 => s[3 + 3 * c + k % 3],
            _ if k % 3 == c => s[12 + c],
            _ => 0.0,
        };
        let colour: [f32; 3] =
            std::array::from_fn(|c| (0..9).map(|k| row(c, k) * q[k]).sum::<f32>());
        let diffuse = glam::Vec3::from_slice(&s[12..]).normalize();
        let colour = glam::Vec3::from_array(colour);
        let z =
            equations.weight.get(0, i) * (colour - DIFFUSE_SHARE * diffuse.dot(colour) * diffuse);
        let by: [f32; 9] = std::array::from_fn(|k| (0..3).map(|c| row(c, k) * z[c]).sum());
        by
    });
    let gathered = equations.taps.gather::<9>(&by, 0);
    let soft = equations.blur.adjoint(&channels(&gathered, 3));
    let sharp = channels(&gathered, 0);
    let by_deviation: Vec<f32> = (0..3 * TEXELS)
        .map(|at| {
            let (x, y) = (at / 3 % SIDE, at / 3 / SIDE);
            let mut pull = 0.0;
            let near = [(x > 0, at.wrapping_sub(3)), (x + 1 < SIDE, at + 3)];
            let line = 3 * SIDE;
            let far = [(y > 0, at.wrapping_sub(line)), (y + 1 < SIDE, at + line)];
            for (_, other) in near.into_iter().chain(far).filter(|(inside, _)| *inside) {
                pull += deviation[at] - deviation[other];
            }
            sharp[at] + soft[at] + flatness * deviation[at] + smoothness * pull
        })
        .collect();
    let heights =
        field.adjoint(&by_deviation).into_iter().zip(x).map(|(g, x)| g + height_damping * x);
    let albedo = channels(&gathered, 6).into_iter().zip(&x[TEXELS..]);
    heights.chain(albedo.map(|(g, x)| g + albedo_damping * x)).collect()
}

fn dot(a: &[f32], b: &[f32]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
}

pub fn conjugate_gradients(backend: &dyn Backend) {
    let config = PaperConfig::default();
    let (samples, _) = problem(&config);
    let len = samples.len();
    let field = HeightField::new(&Atlas::new(&testing::dome(24), SIDE), 6.0);
    let blur = Blur::new(SIDE, 3, 1.5);
    let slopes = Planes::from_fn::<15>(len, |i| std::array::from_fn(|row| noise(row, i) - 0.3));
    let weight = Planes::from_fn(len, |i| [0.5 + noise(20, i)]);
    let right_hand_side: Vec<f32> = (0..4 * TEXELS).map(|i| noise(30, i) - 0.5).collect();
    let start: Vec<f32> = (0..4 * TEXELS).map(|i| 0.01 * noise(40, i)).collect();
    let [flatness, smoothness, height_damping, albedo_damping] = WEIGHTS;
    let equations = NormalEquations {
        taps: &samples.taps,
        slopes: &slopes,
        weight: &weight,
        right_hand_side: &right_hand_side,
        x: &start,
        basis: field.basis(),
        blur: &blur,
        flatness,
        smoothness,
        height_damping,
        albedo_damping,
        diffuse_share: DIFFUSE_SHARE,
        tolerance: 1e-12,
    };
    let mut descent = backend.descent(&equations).unwrap();
    descent.steps(5).unwrap();
    descent.steps(STEPS - 5).unwrap();
    let found = descent.unknowns().unwrap();

    let mut x = start.clone();
    let a_x = product_with_matrix(&equations, &field, &x);
    let mut residual: Vec<f32> = right_hand_side.iter().zip(&a_x).map(|(b, a_x)| b - a_x).collect();
    let (mut direction, mut norm2) = (residual.clone(), dot(&residual, &residual));
    for _ in 0..STEPS {
        let a_direction = product_with_matrix(&equations, &field, &direction);
        let alpha = (norm2 / dot(&direction, &a_direction)) as f32;
        x.iter_mut().zip(&direction).for_each(|(x, d)| *x += alpha * d);
        residual.iter_mut().zip(&a_direction).for_each(|(r, a)| *r -= alpha * a);
        let next = dot(&residual, &residual);
        let beta = (next / norm2) as f32;
        direction.iter_mut().zip(&residual).for_each(|(d, r)| *d = r + beta * *d);
        norm2 = next;
    }
    for (what, part) in [("heights", 0..TEXELS), ("albedo", TEXELS..4 * TEXELS)] {
        let [found, x, start] = [&found, &x, &start].map(|values| &values[part.clone()]);
        let distance = |a: &[f32], b: &[f32]| -> f64 {
            a.iter().zip(b).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>().sqrt()
        };
        let (off, way) = (distance(found, x), distance(x, start));
        assert!(off < 1e-4 * way, "{what}: {off} of {way}");
    }
}
