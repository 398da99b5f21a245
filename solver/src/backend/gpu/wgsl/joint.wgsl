// Forward pass, shading and backward pass of all three networks. A workgroup processes tiles of 64 samples, one thread
// per sample. For each tile, gradients and inputs of all layers of one network are in workgroup memory, and each thread
// sums the outer products of its block of weights over its part of the tile's samples: no atomics, a fixed order. The
// networks are unrolled, so that weights are operands from the constant cache, and activations and sums are in
// registers. The hidden layers are evaluated twice, which needs 56 instead of 168 live registers besides the 60 of the
// sums.

struct Parameters {
    tiles: u32,
    // The workgroups of this dispatch, and of all earlier ones.
    groups: u32,
    first_group: u32,
    scale: f32,
    // 0, unknown to the compiler. Otherwise it might merge both evaluations, and keep all hidden layers in between.
    nothing: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(2) var<storage, read> position: array<f32>;
@group(0) @binding(3) var<storage, read> directions: array<f32>;
@group(0) @binding(4) var<storage, read> pixels: array<f32>;
@group(0) @binding(5) var<storage, read> albedo: array<f32>;
@group(0) @binding(6) var<storage, read_write> by_albedo: array<f32>;
@group(0) @binding(7) var<storage, read_write> partial_sums: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> losses: array<f32>;

const TILE: u32 = 64u;
// Threads per block, samples per thread; blocks per thread.
const PARTS: u32 = max(1u, TILE / BLOCKS);
const PART: u32 = TILE / PARTS;
// One more than the samples, which avoids bank conflicts.
const STRIDE: u32 = TILE + 1u;

// Inputs of every layer: x, y, z, 1; then the hidden ones.
var<workgroup> inputs: array<vec4<f32>, (1u + HIDDEN) * STRIDE>;
// Gradients before the activation of every layer.
var<workgroup> deltas: array<vec4<f32>, (HIDDEN + O) * STRIDE>;
var<workgroup> sums: array<f32, TILE>;

// The offsets of the inputs and the gradients of a block.
fn rows_of(block: u32) -> vec2<u32> {
    if block < W {
        return vec2(0u, block);
    }
    let at = block - W;
    let l = 1u + at / (W * W);
    if l < H {
        return vec2(1u + (l - 1u) * W + at % W, l * W + at % (W * W) / W);
    }
    let last = at - (H - 1u) * W * W;
    return vec2(1u + (H - 1u) * W + last % W, HIDDEN + last / W);
}

fn network_input(network: u32, i: u32) -> vec3<f32> {
    if network == 0u {
        return vec3(position[place(i, 0u, 3u)], position[place(i, 1u, 3u)], position[place(i, 2u, 3u)]);
    }
    let row = 3u * (network - 1u);
    return vec3(directions[place(i, row, 6u)], directions[place(i, row + 1u, 6u)],
        directions[place(i, row + 2u, 6u)]);
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let number = linear(group, groups);
    if number >= parameters.groups {
        return;
    }
    var products: array<mat4x4<f32>, 3u * SHARES>;
    var biases: array<vec4<f32>, 3u * SHARES>;
    var loss = 0.0;
    for (var tile = number; tile < parameters.tiles; tile += parameters.groups) {
        let i = tile * TILE + t;
        var outputs: array<Outputs, 3>;
        #for network in 0..3
            var h: Hidden;
            hidden_layers(network, network_input(network, i), &h);
            outputs[network] = output_layer(network, &h);
        #end
        let light = exponentials(outputs[0]);
        let diffuse = softpluses(outputs[1]);
        let specular = softpluses(outputs[2]);
        let albedos = vec4(albedo[place(i, 0u, 4u)], albedo[place(i, 1u, 4u)],
            albedo[place(i, 2u, 4u)], albedo[place(i, 3u, 4u)]);
        let pixel = shaded(i, albedos, product(light, diffuse), product(light, specular), parameters.scale);
        loss += pixel.loss;
        #for row in 0..4
            by_albedo[place(i, row, 4u)] = pixel.by_albedo[row];
        #end
        let by_diffuse = pixel.by_diffuse;
        #for j in 0..O
            let by_light = by_diffuse * diffuse[j] + pixel.by_specular * specular[j];
            outputs[1][j] = by_diffuse * light[j] * logistic(outputs[1][j]);
            outputs[2][j] = pixel.by_specular * light[j] * logistic(outputs[2][j]);
            outputs[0][j] = by_light * light[j];
        #end
        #for network in 0..3
            let x = network_input(network, i + parameters.nothing);
            var h: Hidden;
            var by_hidden: Hidden;
            hidden_layers(network, x, &h);
            backward(network, &h, outputs[network], &by_hidden);
            inputs[t] = vec4(x, 1.0);
            #for j in 0..HIDDEN
                inputs[(1u + j) * STRIDE + t] = h[j];
                deltas[j * STRIDE + t] = by_hidden[j];
            #end
            #for j in 0..O
                deltas[(HIDDEN + j) * STRIDE + t] = outputs[network][j];
            #end
            workgroupBarrier();
            #for share in 0..SHARES
                let block = select(t % BLOCKS, t + share * TILE, SHARES > 1u);
                let part = select(t / BLOCKS, 0u, SHARES > 1u);
                if part < PARTS && block < BLOCKS {
                    let rows = rows_of(block) * STRIDE + part * PART;
                    var sum = products[network * SHARES + share];
                    var bias = biases[network * SHARES + share];
                    for (var s = 0u; s < PART; s++) {
                        let x = inputs[rows.x + s];
                        let d = deltas[rows.y + s];
                        sum[0] += d * x.x;
                        sum[1] += d * x.y;
                        sum[2] += d * x.z;
                        sum[3] += d * x.w;
                        bias += d;
                    }
                    products[network * SHARES + share] = sum;
                    biases[network * SHARES + share] = bias;
                }
            #end
            workgroupBarrier();
        #end
    }
    let all = parameters.first_group + number;
    #for network in 0..3
        #for share in 0..SHARES
            let sum = network * SHARES + share;
            let first = ((all * 3u * SHARES + sum) * TILE + t) * 5u;
            #for column in 0..4
                partial_sums[first + column] = products[sum][column];
            #end
            partial_sums[first + 4u] = biases[sum];
        #end
    #end
    sums[t] = loss;
    workgroupBarrier();
    if t == 0u {
        var sum = 0.0;
        for (var s = 0u; s < TILE; s++) {
            sum += sums[s];
        }
        losses[all] = sum * parameters.scale;
    }
}
