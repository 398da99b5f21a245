// The scalars of the conjugate gradients, by one workgroup from the parts of a dot product. WHAT: 0 the initial squared
// norm, 1 alpha, 2 the next squared norm and beta.

struct Scalars {
    // Squared norm of the residual, and its value at convergence.
    residual_norm2: f32,
    tolerance: f32,
    alpha: f32,
    beta: f32,
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
    // After convergence, steps change nothing.
    let moves = scalars.residual_norm2 > scalars.tolerance;
    if WHAT == 0u {
        scalars.residual_norm2 = sums[0];
    } else if WHAT == 1u {
        scalars.alpha = select(0.0, scalars.residual_norm2 / sums[0], moves);
    } else {
        scalars.beta = select(0.0, sums[0] / scalars.residual_norm2, moves);
        scalars.residual_norm2 = select(scalars.residual_norm2, sums[0], moves);
    }
}
