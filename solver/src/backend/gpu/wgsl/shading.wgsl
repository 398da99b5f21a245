// L(p) of every sample, or S_d and S_s from L(p). WHAT: 0 the light, 1 the shading.

struct Parameters {
    samples: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
// Positions, or directions.
@group(0) @binding(2) var<storage, read> network_inputs: array<f32>;
@group(0) @binding(3) var<storage, read> light: array<f32>;
@group(0) @binding(4) var<storage, read_write> result: array<f32>;

fn evaluated(network: u32, i: u32, first: u32, rows: u32) -> Outputs {
    var h: Hidden;
    let x = vec3(network_inputs[place(i, first, rows)], network_inputs[place(i, first + 1u, rows)],
        network_inputs[place(i, first + 2u, rows)]);
    hidden_layers(network, x, &h);
    return output_layer(network, &h);
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let i = linear(group, groups) * 64u + t;
    if i >= parameters.samples {
        return;
    }
    if WHAT == 0u {
        let z = exponentials(evaluated(0u, i, 0u, 3u));
        #for j in 0..O
            #for k in 0..4
                result[place(i, 4u * j + k, 4u * O)] = z[j][k];
            #end
        #end
        return;
    }
    #for term in 0..2
        let kernel = softpluses(evaluated(1u + term, i, 3u * term, 6u));
        var sum = 0.0;
        #for j in 0..O
            #for k in 0..4
                sum += light[place(i, 4u * j + k, 4u * O)] * kernel[j][k];
            #end
        #end
        result[place(i, term, 2u)] = sum;
    #end
}
