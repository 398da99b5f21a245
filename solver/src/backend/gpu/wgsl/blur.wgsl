// One axis of the Gaussian blur of a texture of 3 channels; see model/blur.rs. VERTICAL: the axis. SCALED: the inverse
// sum of the weights inside the texture multiplies 0 nothing, 1 the input, 2 the result.

struct Parameters {
    size: u32,
    // Texels to which the kernel reaches on either side.
    reach: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
// Weights from the centre outwards.
@group(0) @binding(1) var<storage, read> kernel: array<f32>;
@group(0) @binding(2) var<storage, read> norms: array<f32>;
@group(0) @binding(3) var<storage, read> texels: array<f32>;
@group(0) @binding(4) var<storage, read_write> blurred: array<f32>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let at = linear(group, groups) * 256u + t;
    let size = parameters.size;
    if at >= 3u * size * size {
        return;
    }
    let x = at / 3u % size;
    let y = at / (3u * size);
    let centre = select(x, y, VERTICAL == 1u);
    let stride = select(3u, 3u * size, VERTICAL == 1u);
    let reach = parameters.reach;
    let first = max(centre, reach) - reach;
    let last = min(centre + reach, size - 1u);
    var sum = 0.0;
    for (var place = first; place <= last; place++) {
        var value = texels[at + place * stride - centre * stride];
        if SCALED == 1u {
            value *= norms[place] * norms[select(y, x, VERTICAL == 1u)];
        }
        sum += kernel[max(place, centre) - min(place, centre)] * value;
    }
    blurred[at] = select(sum, sum * norms[x] * norms[y], SCALED == 2u);
}
