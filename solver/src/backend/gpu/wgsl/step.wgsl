// The vectors of the conjugate gradients. WHAT: 0 their start, where `rest` is the goal; 1 a step; 2 the next
// direction.

struct Scalars {
    energy: f32,
    enough: f32,
    length: f32,
    turn: f32,
}

struct Parameters {
    count: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> scalars: Scalars;
@group(0) @binding(2) var<storage, read> image: array<f32>;
@group(0) @binding(3) var<storage, read_write> x: array<f32>;
@group(0) @binding(4) var<storage, read_write> rest: array<f32>;
@group(0) @binding(5) var<storage, read_write> direction: array<f32>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let at = linear(group, groups) * 256u + t;
    if at >= parameters.count {
        return;
    }
    if WHAT == 0u {
        rest[at] -= image[at];
        direction[at] = rest[at];
    } else if WHAT == 1u {
        x[at] += scalars.length * direction[at];
        rest[at] -= scalars.length * image[at];
    } else {
        direction[at] = rest[at] + scalars.turn * direction[at];
    }
}
