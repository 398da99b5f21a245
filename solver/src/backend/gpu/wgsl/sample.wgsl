// Samples a texture of CHANNELS channels bilinearly.

struct Parameters {
    samples: u32,
    size: u32,
    // The first row that is written, and the number of rows of the planes.
    row: u32,
    rows: u32,
    // Offset of the texture in its buffer.
    first: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> cell: array<u32>;
@group(0) @binding(2) var<storage, read> fraction: array<vec2<f32>>;
@group(0) @binding(3) var<storage, read> texels: array<f32>;
@group(0) @binding(4) var<storage, read_write> sampled: array<f32>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let i = linear(group, groups) * 256u + t;
    if i >= parameters.samples {
        return;
    }
    let above = parameters.first + cell[i] * CHANNELS;
    let below = above + parameters.size * CHANNELS;
    let f = fraction[i];
    #for c in 0..CHANNELS
        let a = texels[above + c];
        let b = texels[below + c];
        let upper = a + f.x * (texels[above + CHANNELS + c] - a);
        let lower = b + f.x * (texels[below + CHANNELS + c] - b);
        sampled[place(i, parameters.row + c, parameters.rows)] = upper + f.y * (lower - upper);
    #end
}
