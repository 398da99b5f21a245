// One step of a pyramid on a texture of 3 channels; see model/pyramid.rs. DOUBLE: 0 halves a texture, 1 interpolates it
// to twice its side. SCALED: whether the finer texture's values are multiplied by the inverse sum of the weights inside
// it.

struct Parameters {
    // Side of the finer texture.
    size: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> norms: array<f32>;
@group(0) @binding(2) var<storage, read> texels: array<f32>;
@group(0) @binding(3) var<storage, read_write> result: array<f32>;

// The weight of a fine texel in a coarse one: three quarters in the coarse texel that contains it, a quarter in the
// nearest neighbour; clamped at the border.
fn weight(fine: u32, coarse: u32, size: u32) -> f32 {
    if fine / 2u != coarse {
        return 0.25;
    }
    return select(0.75, 1.0, fine == 0u || fine == size - 1u);
}

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let at = linear(group, groups) * 256u + t;
    let size = parameters.size;
    let side = select(size / 2u, size, DOUBLE == 1u);
    if at >= 3u * side * side {
        return;
    }
    let x = at / 3u % side;
    let y = at / (3u * side);
    let channel = at % 3u;
    // The first and the last texel of the other texture.
    var first = vec2(2u * max(x, 1u) - 1u, 2u * max(y, 1u) - 1u);
    var last = vec2(2u * x + 2u, 2u * y + 2u);
    var other = size;
    if DOUBLE == 1u {
        first = vec2((max(x, 1u) - 1u) / 2u, (max(y, 1u) - 1u) / 2u);
        last = vec2((x + 1u) / 2u, (y + 1u) / 2u);
        other = size / 2u;
    } else {
        first = select(first, vec2(0u), vec2(x, y) == vec2(0u));
    }
    last = min(last, vec2(other - 1u));
    var sum = 0.0;
    for (var v = first.y; v <= last.y; v++) {
        var line = 0.0;
        for (var u = first.x; u <= last.x; u++) {
            var value = texels[3u * (v * other + u) + channel];
            if DOUBLE == 1u {
                value *= weight(x, u, size);
            } else {
                value *= weight(u, x, size);
                if SCALED == 1u {
                    value *= norms[u];
                }
            }
            line += value;
        }
        if DOUBLE == 1u {
            line *= weight(y, v, size);
        } else {
            line *= weight(v, y, size);
            if SCALED == 1u {
                line *= norms[v];
            }
        }
        sum += line;
    }
    if DOUBLE == 1u && SCALED == 1u {
        sum *= norms[x] * norms[y];
    }
    result[at] = sum;
}
