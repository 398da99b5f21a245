// The adjoint of `sample`: every texel sums the gradients of the samples around it, which lie in two
// runs, in their order. LANES threads share a texel; CHANNELS rows become the texel's channels.

struct Parameters {
    // Side of the texture, texels.
    size: u32,
    // Texels of this dispatch.
    first_texel: u32,
    texels: u32,
    // The first sample of this piece, and their number.
    first: u32,
    samples: u32,
    // The first row that is read, and the number of rows of the planes.
    row: u32,
    rows: u32,
    // 1: add to the existing values.
    add: u32,
    // Offset of the gradient in its buffer.
    offset: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
// First sample of every cell, over all pieces.
@group(0) @binding(1) var<storage, read> start: array<u32>;
@group(0) @binding(2) var<storage, read> fraction: array<vec2<f32>>;
@group(0) @binding(3) var<storage, read> by_sample: array<f32>;
@group(0) @binding(4) var<storage, read_write> gradient: array<f32>;

const WORKERS: u32 = 64u;

var<workgroup> sums: array<array<f32, CHANNELS>, WORKERS>;

// The first sample of a cell, within this piece.
fn begin(at: u32) -> u32 {
    return min(max(start[at], parameters.first) - parameters.first, parameters.samples);
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let number = linear(group, groups) * (WORKERS / LANES) + t / LANES;
    let lane = t % LANES;
    let here = number < parameters.texels;
    let texel = parameters.first_texel + number;
    let size = parameters.size;
    let x = texel % size;
    let y = texel / size;
    var sum: array<f32, CHANNELS>;
    // The cells above and below the texel.
    for (var half = 0u; half < 2u; half++) {
        if here && y + half >= 1u {
            let own = (y + half - 1u) * size + x;
            // First the samples of the cell to the left, whose right texel this is, then those of the texel's own cell.
            let middle = begin(own);
            let end = begin(own + 1u);
            for (var i = begin(select(own, own - 1u, x > 0u)) + lane; i < end; i += LANES) {
                let f = fraction[i];
                let across = select(1.0 - f.x, f.x, i < middle);
                let factor = across * select(1.0 - f.y, f.y, half == 0u);
                #for c in 0..CHANNELS
                    sum[c] += factor * by_sample[place(i, parameters.row + c, parameters.rows)];
                #end
            }
        }
    }
    sums[t] = sum;
    for (var half = LANES / 2u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if lane < half {
            for (var c = 0u; c < CHANNELS; c++) {
                sums[t][c] += sums[t + half][c];
            }
        }
    }
    workgroupBarrier();
    if here && lane == 0u {
        for (var c = 0u; c < CHANNELS; c++) {
            let at = parameters.offset + texel * CHANNELS + c;
            let before = select(0.0, gradient[at], parameters.add == 1u);
            gradient[at] = before + sums[t][c];
        }
    }
}
