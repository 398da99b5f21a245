// Adds the workgroups' partial sums of `joint` in a fixed order: one workgroup per vec4 of the networks.

struct Parameters {
    // Workgroups of `joint`.
    groups: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> partial_sums: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> gradient: array<vec4<f32>>;

const TILE: u32 = 64u;
const BLOCKS: u32 = W + (H - 1u) * W * W + O * W;
const BIASES: u32 = 4u * BLOCKS;
const NETWORK: u32 = BIASES + (H - 1u) * W + O;
const PARTS: u32 = max(1u, TILE / BLOCKS);

var<workgroup> sums: array<vec4<f32>, TILE>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let at = linear(group, groups);
    if at >= 3u * NETWORK {
        return;
    }
    let network = at / NETWORK;
    let within = at % NETWORK;
    var block = within / 4u;
    var column = within % 4u;
    if within >= BIASES {
        // A bias is stored with the first block of its row of blocks.
        block = W + (within - BIASES) * W;
        column = 4u;
    }
    var sum = vec4(0.0);
    for (var source = t; source < parameters.groups; source += TILE) {
        for (var part = 0u; part < PARTS; part++) {
            let share = network * SHARES + block / TILE;
            let thread = block % TILE + part * BLOCKS;
            sum += partial_sums[((source * 3u * SHARES + share) * TILE + thread) * 5u + column];
        }
    }
    sums[t] = sum;
    workgroupBarrier();
    for (var half = TILE / 2u; half > 0u; half /= 2u) {
        if t < half {
            sums[t] += sums[t + half];
        }
        workgroupBarrier();
    }
    if t == 0u {
        gradient[at] = sums[0];
    }
}
