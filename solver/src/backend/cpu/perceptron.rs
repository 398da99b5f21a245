//! One multilayer perceptron on a block of samples: forward, backward, weight gradients.
//!
//! Products are computed in tiles of 4 outputs x `C` vectors, whose 4 C partial sums stay in registers; weights are
//! packed in the order in which tiles read them. Gradients of weights are summed in tiles of 4 outputs x `C` inputs,
//! with the biases.

use super::ahead::Ahead;
use super::lanes::{Lanes, Task};
use crate::model::networks::{Network, Networks};
use crate::model::planes::{BLOCK, Row};

/// Outputs per tile.
const TILE: usize = 4;
/// Inputs of the first layer; the inputs of other layers are a multiple of [`TILE`].
const INPUTS: usize = 3;

/// A network's weights in the order of the tiles.
pub struct Packed {
    layers: Vec<PackedLayer>,
    /// The transposed matrix of the first layer.
    to_inputs: Vec<[f32; INPUTS]>,
}

struct PackedLayer {
    /// Tile by tile, input by input: weights to the tile's outputs.
    forward: Vec<[f32; TILE]>,
    bias: Vec<[f32; TILE]>,
    /// Tiles of the transposed matrix, as in `forward`; empty in the first layer.
    backward: Vec<[f32; TILE]>,
}

impl Packed {
    pub fn new(networks: &Networks, network: Network) -> Self {
        let pack = |layer: usize| {
            let (inputs, outputs) = (networks.shape[layer], networks.shape[layer + 1]);
            let (weights, biases) = networks.place(network, layer);
            let (weights, biases) = (&networks.parameters[weights], &networks.parameters[biases]);
            let at = |output: usize, input: usize| weights[output * inputs + input];
            let transposed = |input: usize, output: usize| at(output, input);
            PackedLayer {
                forward: tiles(outputs, inputs, &at),
                bias: biases.as_chunks().0.to_vec(),
                backward: if layer > 0 { tiles(inputs, outputs, &transposed) } else { vec![] },
            }
        };
        let (weights, _) = networks.place(network, 0);
        let weights = networks.parameters[weights].as_chunks().0.to_vec();
        Self { layers: (0..networks.layers()).map(pack).collect(), to_inputs: weights }
    }
}

/// A matrix, tile of rows by tile of rows, column by column.
fn tiles(rows: usize, columns: usize, at: &dyn Fn(usize, usize) -> f32) -> Vec<[f32; TILE]> {
    (0..rows / TILE)
        .flat_map(|tile| (0..columns).map(move |column| (tile * TILE, column)))
        .map(|(row, column)| std::array::from_fn(|i| at(row + i, column)))
        .collect()
}

/// Activations of a block, and room for gradients.
pub struct Trace {
    /// Outputs of every layer; the caller may replace those of the last one.
    pub layers: Vec<Vec<Row>>,
    /// Gradients of the current layer and of the previous one.
    delta: [Vec<Row>; 2],
}

impl Trace {
    pub fn new(networks: &Networks) -> Self {
        let widest = networks.shape.iter().max().map_or(0, |w| w.next_multiple_of(TILE));
        let layers = networks.shape[1..].iter().map(|width| vec![Row::ZERO; *width]).collect();
        Self { layers, delta: [vec![Row::ZERO; widest], vec![Row::ZERO; widest]] }
    }

    /// The last layer's outputs; for [`backward`], their gradients.
    pub fn outputs(&mut self) -> &mut [Row] {
        self.layers.last_mut().map_or(&mut [], Vec::as_mut_slice)
    }
}

/// Computes all layers; ReLU between them, nothing after the last.
#[inline(always)]
pub fn forward<S: Lanes, const C: usize>(
    packed: &Packed,
    input: &[Row],
    trace: &mut Trace,
    ahead: &mut Ahead,
) {
    let last = packed.layers.len() - 1;
    for (index, layer) in packed.layers.iter().enumerate() {
        let (before, rest) = trace.layers.split_at_mut(index);
        let input = before.last().map_or(input, Vec::as_slice);
        let (weights, bias, output) = (&layer.forward, &layer.bias, &mut rest[0]);
        if index < last {
            S::out_of_line(Product::<C, RELU> { weights, bias, input, gate: &[], output, ahead });
        } else {
            S::out_of_line(Product::<C, PLAIN> { weights, bias, input, gate: &[], output, ahead });
        }
    }
}

/// Propagates the gradients in [`Trace::outputs`] back to weights and biases (added to `sums`, in the order of the
/// parameters) and, if requested, to the inputs (3 rows).
#[inline(always)]
pub fn backward<S: Lanes, const C: usize>(
    packed: &Packed,
    input: &[Row],
    trace: &mut Trace,
    mut sums: Option<&mut [f32]>,
    mut by_input: Option<&mut [Row]>,
    ahead: &mut Ahead,
) {
    let [mut delta, mut next] = std::mem::take(&mut trace.delta);
    let last = packed.layers.len() - 1;
    let top = std::mem::take(&mut trace.layers[last]);
    for (index, layer) in packed.layers.iter().enumerate().rev() {
        let input = if index == 0 { input } else { &trace.layers[index - 1] };
        let by_output = if index == last { &top } else { &delta[..trace.layers[index].len()] };
        if let Some(sums) = sums.as_deref_mut() {
            let before = packed.layers[..index].iter().map(PackedLayer::parameters).sum::<usize>();
            let sums = &mut sums[before..before + layer.parameters()];
            S::out_of_line(WeightGradient::<C> { delta: by_output, input, sums, ahead });
        }
        if index > 0 {
            let (weights, bias, gate) = (&layer.backward, &[], input);
            let (input, output) = (by_output, &mut next[..gate.len()]);
            S::out_of_line(Product::<C, GATED> { weights, bias, input, gate, output, ahead });
        } else if let Some(output) = by_input.as_deref_mut() {
            let (weights, input) = (&packed.to_inputs, by_output);
            let bias = &[];
            S::out_of_line(Product::<C, PLAIN, INPUTS> {
                weights,
                bias,
                input,
                gate: &[],
                output,
                ahead,
            });
        }
        std::mem::swap(&mut delta, &mut next);
    }
    trace.layers[last] = top;
    trace.delta = [delta, next];
}

impl PackedLayer {
    fn parameters(&self) -> usize {
        TILE * (self.forward.len() + self.bias.len())
    }
}

/// The activation after a product: none, ReLU, or zero where another ReLU was closed.
const PLAIN: u8 = 0;
const RELU: u8 = 1;
const GATED: u8 = 2;

/// output = matrix x input (+ bias), through `THEN`; `gate` has the activations that close gates.
struct Product<'a, 'b, const C: usize, const THEN: u8, const R: usize = TILE> {
    weights: &'a [[f32; R]],
    bias: &'a [[f32; R]],
    input: &'a [Row],
    gate: &'a [Row],
    output: &'a mut [Row],
    ahead: &'a mut Ahead<'b>,
}

impl<const C: usize, const THEN: u8, const R: usize> Task for Product<'_, '_, C, THEN, R> {
    #[inline(always)]
    fn run<S: Lanes>(self) {
        let Self { weights, bias, input, gate, output, ahead } = self;
        for (tile, output) in output.chunks_exact_mut(R).enumerate() {
            let weights = &weights[tile * input.len()..][..input.len()];
            let bias = bias.get(tile).copied().unwrap_or([0.0; R]);
            let mut at = 0;
            while at < BLOCK {
                ahead.ask();
                let mut sums = [[S::splat(0.0); C]; R];
                // The last products of gated inputs are masked, so they are left to the end.
                let open = if THEN == GATED { input.len() - 1 } else { input.len() };
                for (weights, row) in weights.iter().zip(&input[..open]) {
                    let mut x = [S::splat(0.0); C];
                    for (c, x) in x.iter_mut().enumerate() {
                        *x = S::load(row, at + c * S::WIDTH);
                    }
                    for (sums, weight) in sums.iter_mut().zip(weights) {
                        let weight = S::splat(*weight);
                        for (sum, x) in sums.iter_mut().zip(x) {
                            *sum = weight.mul_add(x, *sum);
                        }
                    }
                }
                if THEN == GATED {
                    let (weights, x) = (&weights[open], &input[open]);
                    for (index, (sums, weight)) in sums.iter_mut().zip(weights).enumerate() {
                        let weight = S::splat(*weight);
                        for (c, sum) in sums.iter_mut().enumerate() {
                            let at = at + c * S::WIDTH;
                            let gate = S::load(&gate[tile * R + index], at);
                            *sum = weight.mul_add_where(S::load(x, at), *sum, gate);
                        }
                    }
                }
                for (index, (row, sums)) in output.iter_mut().zip(sums).enumerate() {
                    let bias = S::splat(bias[index]);
                    for (c, sum) in sums.into_iter().enumerate() {
                        let at = at + c * S::WIDTH;
                        let value = match THEN {
                            RELU => S::splat(0.0).max(sum.add(bias)),
                            GATED => sum,
                            _ => sum.add(bias),
                        };
                        value.store(row, at);
                    }
                }
                at += C * S::WIDTH;
            }
        }
    }
}

/// Adds delta x input^T and the sum of delta to the sums of weights and biases.
struct WeightGradient<'a, 'b, const C: usize> {
    delta: &'a [Row],
    input: &'a [Row],
    sums: &'a mut [f32],
    ahead: &'a mut Ahead<'b>,
}

impl<const C: usize> Task for WeightGradient<'_, '_, C> {
    #[inline(always)]
    fn run<S: Lanes>(self) {
        let Self { delta, input, sums, ahead } = self;
        let (weights, biases) = sums.split_at_mut(delta.len() * input.len());
        let (tiles, rest) = input.as_chunks::<C>();
        let rows = weights.chunks_exact_mut(TILE * input.len()).zip(biases.as_chunks_mut().0);
        for (delta, (weights, bias)) in delta.as_chunks().0.iter().zip(rows) {
            for (tile, input) in tiles.iter().enumerate() {
                ahead.ask();
                if tile == 0 {
                    outer::<S, C, true>(delta, input, 0, weights, bias);
                } else {
                    outer::<S, C, false>(delta, input, tile * C, weights, bias);
                }
            }
            // Three inputs are less than a tile of four, or one more than a tile of two.
            if let Some(input) = rest.first_chunk() {
                ahead.ask();
                outer::<S, INPUTS, true>(delta, input, 0, weights, bias);
            } else if let Some(input) = rest.first_chunk() {
                ahead.ask();
                outer::<S, 1, false>(delta, input, INPUTS - 1, weights, bias);
            }
        }
    }
}

/// One tile of the outer product, 4 x `K` from a column on, and with `BIAS` the sums of delta.
#[inline(always)]
fn outer<S: Lanes, const K: usize, const BIAS: bool>(
    delta: &[Row; TILE],
    input: &[Row; K],
    column: usize,
    weights: &mut [f32],
    bias: &mut [f32; TILE],
) {
    let mut sums = [[S::splat(0.0); K]; TILE];
    let mut totals = [S::splat(0.0); TILE];
    let mut at = 0;
    while at < BLOCK {
        let mut x = [S::splat(0.0); K];
        for (x, row) in x.iter_mut().zip(input) {
            *x = S::load(row, at);
        }
        for (j, (sums, row)) in sums.iter_mut().zip(delta).enumerate() {
            let d = S::load(row, at);
            for (sum, x) in sums.iter_mut().zip(x) {
                *sum = d.mul_add(x, *sum);
            }
            if BIAS {
                totals[j] = totals[j].add(d);
            }
        }
        at += S::WIDTH;
    }
    let stride = weights.len() / TILE;
    for (weights, sums) in weights.chunks_exact_mut(stride).zip(sums) {
        let mut four = [S::splat(0.0); TILE];
        four[..K].copy_from_slice(&sums);
        for (place, sum) in weights[column..column + K].iter_mut().zip(S::sums(four)) {
            *place += sum;
        }
    }
    if BIAS {
        for (place, sum) in bias.iter_mut().zip(S::sums(totals)) {
            *place += sum;
        }
    }
}
