//! The passes over a chunk of samples, written once for all vector types, and the entry points
//! that compile them for each instruction set.

use super::ahead::Ahead;
use super::directions::{adjoint, deviate};
use super::lanes::{Lanes, Portable};
use super::level::Level;
use super::perceptron::{Packed, Trace, backward, forward};
use super::shade::{self, PixelGradient, Pixels};
use crate::backend::{ALBEDOS, DIRECTION_ROWS, TexturedNormals};
use crate::model::deviation_textures::{ROWS, SPECULAR};
use crate::model::networks::Networks;
use crate::model::normals::DIRECTIONS;
use crate::model::planes::{BLOCK, Planes, Row};
use crate::model::samples::Samples;
use crate::model::strips::{Strip, blocks};

/// Chains of [`peak`]: more than the latency of a multiply-add times its throughput per cycle.
pub const PEAK_CHAINS: usize = 12;

/// Buffers of one task, reused from chunk to chunk.
pub struct Scratch {
    light: Trace,
    diffuse: Trace,
    specular: Trace,
    slopes: [Vec<Row>; 2],
    shading: [Row; 2],
    gradient: PixelGradient,
    /// Gradients with respect to the networks' parameters.
    pub sums: Vec<f32>,
}

impl Scratch {
    pub fn new(networks: &Networks) -> Self {
        let slopes = vec![Row::ZERO; networks.outputs()];
        Self {
            light: Trace::new(networks),
            diffuse: Trace::new(networks),
            specular: Trace::new(networks),
            slopes: [slopes.clone(), slopes],
            shading: [Row::ZERO; 2],
            gradient: PixelGradient { shading: [Row::ZERO; 2], albedo: [Row::ZERO; 4] },
            sums: vec![0.0; networks.parameters.len()],
        }
    }
}

/// The inputs of the passes with a target.
pub struct Inputs<'a> {
    pub packed: &'a [Packed; 3],
    pub samples: &'a Samples,
    pub directions: &'a Planes,
    pub albedo: &'a Planes,
}

impl<'a> Inputs<'a> {
    fn pixels(&self, block: usize) -> Pixels<'a> {
        let Samples { fresnel, target, weight, .. } = self.samples;
        Pixels {
            albedo: self.albedo.block(block),
            specular: &self.albedo.block(block)[3],
            fresnel: &fresnel.block(block)[0],
            target: target.block(block),
            weight: &weight.block(block)[0],
            scale: 1.0 / (3.0 * self.samples.len() as f32),
        }
    }
}

/// Activated outputs of both directional networks, and their slopes.
#[inline(always)]
fn kernels<S: Lanes, const C: usize>(
    packed: &[Packed; 3],
    directions: &[Row],
    s: &mut Scratch,
    ahead: &mut Ahead,
) {
    forward::<S, C>(&packed[1], &directions[..3], &mut s.diffuse, ahead);
    forward::<S, C>(&packed[2], &directions[3..DIRECTIONS], &mut s.specular, ahead);
    shade::softplus::<S>(s.diffuse.outputs(), &mut s.slopes[0]);
    shade::softplus::<S>(s.specular.outputs(), &mut s.slopes[1]);
}

/// Loss, network gradients (into the scratch) and albedo gradients of the blocks from `first` on.
#[inline(always)]
fn joint_body<S: Lanes, const C: usize>(
    inputs: &Inputs,
    first: usize,
    s: &mut Scratch,
    out: &mut [Row],
) -> f64 {
    s.sums.fill(0.0);
    let mut loss = 0.0;
    for (block, out) in out.chunks_exact_mut(ALBEDOS).enumerate() {
        let albedo = inputs.albedo.block(first + block);
        loss += joint_block::<S, C>(inputs, first + block, albedo, s);
        out.copy_from_slice(&s.gradient.albedo);
    }
    loss
}

/// Loss of a strip's samples with the albedos of a texture; gradients go to the strip's texels.
#[inline(always)]
fn joint_textured_body<S: Lanes, const C: usize>(
    inputs: &Inputs,
    texture: &[f32],
    s: &mut Scratch,
    strip: &mut Strip<ALBEDOS>,
) -> f64 {
    s.sums.fill(0.0);
    let mut loss = 0.0;
    let mut albedo = [Row::ZERO; ALBEDOS];
    for (block, lanes) in blocks(strip.samples.clone()) {
        inputs.samples.taps.sample_vectors_of(texture, block, &mut albedo);
        loss += joint_block::<S, C>(inputs, block, &albedo, s);
        strip.add_vectors(block, lanes, &s.gradient.albedo);
    }
    loss
}

#[inline(always)]
fn joint_block<S: Lanes, const C: usize>(
    inputs: &Inputs,
    block: usize,
    albedo: &[Row],
    s: &mut Scratch,
) -> f64 {
    let Samples { position, fresnel, target, weight, .. } = inputs.samples;
    let ahead = [position, inputs.directions, fresnel, target, weight];
    let ahead = &mut Ahead::new(&ahead, block + 1);
    let position = position.block(block);
    let directions = inputs.directions.block(block);
    forward::<S, C>(&inputs.packed[0], position, &mut s.light, ahead);
    shade::exponentials::<S>(s.light.outputs());
    kernels::<S, C>(inputs.packed, directions, s, ahead);
    let (light, diffuse, specular) = (s.light.outputs(), s.diffuse.outputs(), s.specular.outputs());
    shade::dot::<S>(light, diffuse, &mut s.shading[0]);
    shade::dot::<S>(light, specular, &mut s.shading[1]);
    let pixels = Pixels { albedo, specular: &albedo[3], ..inputs.pixels(block) };
    let loss = shade::compose::<S>(&pixels, &s.shading, &mut s.gradient);
    let by_shading = &s.gradient.shading;
    shade::vector_gradients::<S>(by_shading, &s.slopes, light, diffuse, specular);
    let one = s.sums.len() / 3;
    let (a, rest) = s.sums.split_at_mut(one);
    let (b, c) = rest.split_at_mut(one);
    backward::<S, C>(&inputs.packed[0], position, &mut s.light, Some(a), None, ahead);
    backward::<S, C>(&inputs.packed[1], &directions[..3], &mut s.diffuse, Some(b), None, ahead);
    backward::<S, C>(&inputs.packed[2], &directions[3..], &mut s.specular, Some(c), None, ahead);
    loss
}

/// Loss and gradients with respect to directions and specular albedo, with frozen networks.
#[inline(always)]
fn direction_gradient_body<S: Lanes, const C: usize>(
    inputs: &Inputs,
    light: &Planes,
    first: usize,
    s: &mut Scratch,
    out: &mut [Row],
) -> f64 {
    let mut loss = 0.0;
    for (block, out) in out.chunks_exact_mut(DIRECTION_ROWS).enumerate() {
        let block = first + block;
        let (pixels, directions) = (inputs.pixels(block), inputs.directions.block(block));
        let Samples { fresnel, target, weight, .. } = inputs.samples;
        let ahead = [light, inputs.directions, inputs.albedo, fresnel, target, weight];
        let ahead = &mut Ahead::new(&ahead, block + 1);
        let light = light.block(block);
        loss += bend_block::<S, C>(inputs.packed, &pixels, light, directions, s, out, ahead);
        let [by_diffuse, by_specular] = &s.gradient.shading;
        shade::times::<S>(&mut out[..3], by_diffuse);
        shade::times::<S>(&mut out[3..DIRECTIONS], by_specular);
    }
    loss
}

/// Loss of a strip's samples with directions from textures; gradients go to the strip's texels.
#[inline(always)]
fn textured_body<S: Lanes, const C: usize>(
    packed: &[Packed; 3],
    normals: &TexturedNormals,
    s: &mut Scratch,
    strip: &mut Strip<ROWS>,
) -> f64 {
    let TexturedNormals { samples, light, albedo, scale, textures, .. } = *normals;
    let inputs = Inputs { packed, samples, directions: light, albedo };
    let mut loss = 0.0;
    let (mut bent, mut directions) = ([Row::ZERO; ROWS], [Row::ZERO; DIRECTIONS]);
    let (mut gradient, mut by_bent) = ([Row::ZERO; DIRECTION_ROWS], [Row::ZERO; ROWS]);
    let mut lengths = [Row::ZERO; 2];
    for (block, lanes) in blocks(strip.samples.clone()) {
        textures.sample_block(&samples.taps, block, &mut bent);
        let known = [samples.normal.block(block), samples.view.block(block)];
        deviate::<S>(scale, known, &bent, &mut lengths, &mut directions);
        let filled = samples.len() - block * BLOCK;
        if filled < BLOCK {
            // A zero normal has no direction.
            directions.iter_mut().for_each(|row| row.0[filled..].fill(0.0));
        }
        let pixels = Pixels { specular: &bent[SPECULAR], ..inputs.pixels(block) };
        let Samples { normal, view, fresnel, target, weight, .. } = samples;
        let ahead = [light, albedo, normal, view, fresnel, target, weight];
        let ahead = &mut Ahead::new(&ahead, block + 1);
        let light = light.block(block);
        loss += bend_block::<S, C>(packed, &pixels, light, &directions, s, &mut gradient, ahead);
        let factors = &s.gradient.shading;
        adjoint::<S>(scale, known, &bent, &lengths, &gradient, factors, &mut by_bent);
        by_bent[SPECULAR] = gradient[DIRECTIONS];
        strip.add_vectors(block, lanes, &by_bent);
    }
    loss
}

/// The loss, and the gradients with respect to the specular albedo and the directions. The latter are without their
/// factors, the gradients with respect to the shadings.
#[inline(always)]
fn bend_block<S: Lanes, const C: usize>(
    packed: &[Packed; 3],
    pixels: &Pixels,
    light: &[Row],
    directions: &[Row],
    s: &mut Scratch,
    out: &mut [Row],
    ahead: &mut Ahead,
) -> f64 {
    forward::<S, C>(&packed[1], &directions[..3], &mut s.diffuse, ahead);
    shade::kernel::<S>(light, s.diffuse.outputs(), &mut s.shading[0]);
    forward::<S, C>(&packed[2], &directions[3..DIRECTIONS], &mut s.specular, ahead);
    shade::kernel::<S>(light, s.specular.outputs(), &mut s.shading[1]);
    let loss = shade::compose::<S>(pixels, &s.shading, &mut s.gradient);
    let by_input = Some(&mut out[..3]);
    backward::<S, C>(&packed[1], &directions[..3], &mut s.diffuse, None, by_input, ahead);
    let by_input = Some(&mut out[3..DIRECTIONS]);
    backward::<S, C>(&packed[2], &directions[3..], &mut s.specular, None, by_input, ahead);
    out[6] = s.gradient.albedo[3];
    loss
}

/// L(p).
#[inline(always)]
fn light_body<S: Lanes, const C: usize>(
    packed: &[Packed; 3],
    position: &Planes,
    first: usize,
    s: &mut Scratch,
    out: &mut [Row],
) {
    let outputs = s.light.outputs().len();
    for (block, out) in out.chunks_exact_mut(outputs).enumerate() {
        let block = first + block;
        let ahead = &mut Ahead::new(&[position], block + 1);
        forward::<S, C>(&packed[0], position.block(block), &mut s.light, ahead);
        shade::exponentials::<S>(s.light.outputs());
        out.copy_from_slice(s.light.outputs());
    }
}

/// S_d and S_s.
#[inline(always)]
fn shade_body<S: Lanes, const C: usize>(
    packed: &[Packed; 3],
    light: &Planes,
    directions: &Planes,
    first: usize,
    s: &mut Scratch,
    out: &mut [Row],
) {
    for (block, out) in out.chunks_exact_mut(2).enumerate() {
        let block = first + block;
        let ahead = &mut Ahead::new(&[light, directions], block + 1);
        let light = light.block(block);
        kernels::<S, C>(packed, directions.block(block), s, ahead);
        shade::dot::<S>(light, s.diffuse.outputs(), &mut out[0]);
        shade::dot::<S>(light, s.specular.outputs(), &mut out[1]);
    }
}

/// `rounds` x [`PEAK_CHAINS`] multiply-adds on vectors in independent chains; returns the result, so that the compiler
/// does not remove them.
#[inline(always)]
fn peak_body<S: Lanes, const C: usize>(rounds: usize) -> f32 {
    let (factor, term) = (S::splat(0.999), S::splat(1e-3));
    let mut sums = [S::splat(0.5); PEAK_CHAINS];
    for _ in 0..rounds {
        for sum in &mut sums {
            *sum = sum.mul_add(factor, term);
        }
    }
    S::sums([sums.into_iter().reduce(S::add).unwrap_or(term); 4])[0]
}

/// An entry point per instruction set; the tiles are as wide as the registers allow.
macro_rules! entry {
    ($name:ident, $body:ident($($arg:ident: $type:ty),*) $(-> $out:ty)?) => {
        pub fn $name(level: Level, $($arg: $type),*) $(-> $out)? {
            #[cfg(target_arch = "x86_64")]
            {
                use super::lanes::{Avx2, Avx512};
                #[target_feature(enable = "avx512f")]
                fn avx512($($arg: $type),*) $(-> $out)? { $body::<Avx512, 4>($($arg),*) }
                #[target_feature(enable = "avx2,fma")]
                fn avx2($($arg: $type),*) $(-> $out)? { $body::<Avx2, 2>($($arg),*) }
                match level {
                    // SAFETY: levels come from `Level::available`, which found AVX-512 F.
                    Level::Avx512 => return unsafe { avx512($($arg),*) },
                    // SAFETY: levels come from `Level::available`, which found AVX2 and FMA.
                    Level::Avx2 => return unsafe { avx2($($arg),*) },
                    Level::Portable => {}
                }
            }
            #[cfg(target_arch = "aarch64")]
            if level == Level::Neon {
                return $body::<super::lanes::Neon, 4>($($arg),*);
            }
            #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
            let Level::Portable = level;
            $body::<Portable, 2>($($arg),*)
        }
    };
}

entry!(joint, joint_body(inputs: &Inputs, first: usize, s: &mut Scratch, out: &mut [Row]) -> f64);
entry!(joint_textured, joint_textured_body(inputs: &Inputs, texture: &[f32], s: &mut Scratch, strip: &mut Strip<ALBEDOS>) -> f64);
entry!(direction_gradient, direction_gradient_body(inputs: &Inputs, light: &Planes, first: usize, s: &mut Scratch, out: &mut [Row]) -> f64);
entry!(textured, textured_body(packed: &[Packed; 3], normals: &TexturedNormals, s: &mut Scratch, strip: &mut Strip<ROWS>) -> f64);
entry!(light, light_body(packed: &[Packed; 3], position: &Planes, first: usize, s: &mut Scratch, out: &mut [Row]));
entry!(shade_blocks, shade_body(packed: &[Packed; 3], light: &Planes, directions: &Planes, first: usize, s: &mut Scratch, out: &mut [Row]));
entry!(peak, peak_body(rounds: usize) -> f32);
