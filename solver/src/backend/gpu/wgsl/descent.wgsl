// The numbers of the conjugate gradients, by one workgroup from the parts of a product. WHAT: 0 the first
// energy, 1 the length of a step, 2 the energy after it and the turn of the direction.

struct Scalars {
    // Squared norm of what is left, and that which is small enough to stop.
    energy: f32,
    enough: f32,
    length: f32,
    turn: f32,
}

struct Parameters {
    count: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> parts: array<f32>;
@group(0) @binding(2) var<storage, read_write> scalars: Scalars;

var<workgroup> sums: array<f32, 256>;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_index) t: u32) {
    var sum = 0.0;
    for (var at = t; at < parameters.count; at += 256u) {
        sum += parts[at];
    }
    sums[t] = sum;
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if t < half {
            sums[t] += sums[t + half];
        }
        workgroupBarrier();
    }
    if t > 0u {
        return;
    }
    // Once the rest is small enough, nothing moves any more.
    let moves = scalars.energy > scalars.enough;
    if WHAT == 0u {
        scalars.energy = sums[0];
    } else if WHAT == 1u {
        scalars.length = select(0.0, scalars.energy / sums[0], moves);
    } else {
        scalars.turn = select(0.0, sums[0] / scalars.energy, moves);
        scalars.energy = select(scalars.energy, sums[0], moves);
    }
}
