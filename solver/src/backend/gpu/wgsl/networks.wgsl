// Three equal perceptrons in blocks of 4 x 4 weights. Constants: W hidden vec4s, H hidden layers, O
// output vec4s, HIDDEN = H W. A network has its blocks first, layer by layer, output by output, input by input, four
// columns each; then the biases of all layers except the first, whose biases are the fourth column of its blocks (the
// input is x, y, z, 1). See layout.rs.

const BLOCKS: u32 = W + (H - 1u) * W * W + O * W;
const BIASES: u32 = 4u * BLOCKS;
const NETWORK: u32 = BIASES + (H - 1u) * W + O;
alias Hidden = array<vec4<f32>, HIDDEN>;
alias Outputs = array<vec4<f32>, O>;

fn weights_at(at: u32) -> mat4x4<f32> {
    return mat4x4(weights[at], weights[at + 1u], weights[at + 2u], weights[at + 3u]);
}

// First block of layer `l`, from 1 on.
fn layer_block(l: u32) -> u32 {
    return W + (l - 1u) * W * W;
}

fn hidden_layers(network: u32, x: vec3<f32>, h: ptr<function, Hidden>) {
    let base = network * NETWORK;
    let input = vec4(x, 1.0);
    #for j in 0..W
        (*h)[j] = max(weights_at(base + 4u * j) * input, vec4(0.0));
    #end
    #for l in 1..H
        #for j in 0..W
            var sum = weights[base + BIASES + (l - 1u) * W + j];
            #for k in 0..W
                let block = layer_block(l) + j * W + k;
                sum += weights_at(base + 4u * block) * (*h)[(l - 1u) * W + k];
            #end
            (*h)[l * W + j] = max(sum, vec4(0.0));
        #end
    #end
}

// The outputs before the last activation.
fn output_layer(network: u32, h: ptr<function, Hidden>) -> Outputs {
    let base = network * NETWORK;
    var out: Outputs;
    #for j in 0..O
        var sum = weights[base + BIASES + (H - 1u) * W + j];
        #for k in 0..W
            let block = layer_block(H) + j * W + k;
            sum += weights_at(base + 4u * block) * (*h)[(H - 1u) * W + k];
        #end
        out[j] = sum;
    #end
    return out;
}

fn open_gates(h: vec4<f32>) -> vec4<f32> {
    return select(vec4(0.0), vec4(1.0), h > vec4(0.0));
}

// Backpropagates gradients before the last activation to those before every hidden activation.
fn backward(network: u32, h: ptr<function, Hidden>, by_output: Outputs, by_hidden: ptr<function, Hidden>) {
    let base = network * NETWORK;
    #for k in 0..W
        var sum = vec4(0.0);
        #for j in 0..O
            sum += by_output[j] * weights_at(base + 4u * (layer_block(H) + j * W + k));
        #end
        (*by_hidden)[(H - 1u) * W + k] = sum * open_gates((*h)[(H - 1u) * W + k]);
    #end
    #for l in 1..H reversed
        #for k in 0..W
            var sum = vec4(0.0);
            #for j in 0..W
                let block = layer_block(l) + j * W + k;
                sum += (*by_hidden)[l * W + j] * weights_at(base + 4u * block);
            #end
            (*by_hidden)[(l - 1u) * W + k] = sum * open_gates((*h)[(l - 1u) * W + k]);
        #end
    #end
}

// The least argument of an exponential, as on the processor (lanes).
const LEAST = vec4(-40.0);

// e^z, with the range of the processor's.
fn exponentials(z: Outputs) -> Outputs {
    var out: Outputs;
    #for j in 0..O
        // Unlike clamp, this preserves a NaN, so that the loss becomes NaN.
        let least = select(z[j], LEAST, z[j] < LEAST);
        out[j] = exp(select(least, vec4(88.0), least > vec4(88.0)));
    #end
    return out;
}

// log(1 + e^z) = max(z, 0) + 2 artanh(s), s = e / (2 + e), e = e^-|z|.
fn softplus(z: vec4<f32>) -> vec4<f32> {
    let e = exp(max(-abs(z), LEAST));
    let s = e / (2.0 + e);
    let q = s * s;
    var sum = 1.0 / 11.0 + q * (1.0 / 13.0);
    sum = 1.0 / 9.0 + q * sum;
    sum = 1.0 / 7.0 + q * sum;
    sum = 1.0 / 5.0 + q * sum;
    sum = 1.0 / 3.0 + q * sum;
    sum = 1.0 + q * sum;
    return max(z, vec4(0.0)) + 2.0 * s * sum;
}

// The derivative of softplus.
fn logistic(z: vec4<f32>) -> vec4<f32> {
    let e = exp(max(-abs(z), LEAST));
    return select(e, vec4(1.0), z > vec4(0.0)) / (1.0 + e);
}

fn softpluses(z: Outputs) -> Outputs {
    var out: Outputs;
    #for j in 0..O
        out[j] = softplus(z[j]);
    #end
    return out;
}

fn product(a: Outputs, b: Outputs) -> f32 {
    var sum = 0.0;
    #for j in 0..O
        sum += dot(a[j], b[j]);
    #end
    return sum;
}
