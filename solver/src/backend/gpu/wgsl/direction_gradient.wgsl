// The loss, and the gradients with respect to directions and specular albedo, with frozen networks and L(p).

struct Parameters {
    samples: u32,
    first_group: u32,
    scale: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(2) var<storage, read> directions: array<f32>;
@group(0) @binding(3) var<storage, read> light: array<f32>;
@group(0) @binding(4) var<storage, read> pixels: array<f32>;
@group(0) @binding(5) var<storage, read> albedo: array<f32>;
// Rows: both directions, specular albedo.
@group(0) @binding(6) var<storage, read_write> gradient: array<f32>;
@group(0) @binding(7) var<storage, read_write> losses: array<f32>;

var<workgroup> sums: array<f32, 64>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let number = linear(group, groups);
    let i = number * 64u + t;
    var loss = 0.0;
    if i < parameters.samples {
        var by_output: array<Outputs, 2>;
        var l: Outputs;
        #for j in 0..O
            #for k in 0..4
                l[j][k] = light[place(i, 4u * j + k, 4u * O)];
            #end
        #end
        var shading: vec2<f32>;
        #for term in 0..2
            let row = 3u * term;
            let x = vec3(directions[place(i, row, 6u)], directions[place(i, row + 1u, 6u)],
                directions[place(i, row + 2u, 6u)]);
            var h: Hidden;
            hidden_layers(1u + term, x, &h);
            by_output[term] = output_layer(1u + term, &h);
            shading[term] = product(l, softpluses(by_output[term]));
        #end
        let albedos = vec4(albedo[place(i, 0u, 4u)], albedo[place(i, 1u, 4u)],
            albedo[place(i, 2u, 4u)], albedo[place(i, 3u, 4u)]);
        let pixel = shaded(i, albedos, shading.x, shading.y, parameters.scale);
        loss = pixel.loss;
        gradient[place(i, 6u, 7u)] = pixel.by_albedo.w;
        let by_shading = vec2(pixel.by_diffuse, pixel.by_specular);
        #for term in 0..2
            let row = 3u * term;
            let x = vec3(directions[place(i, row, 6u)], directions[place(i, row + 1u, 6u)],
                directions[place(i, row + 2u, 6u)]);
            var h: Hidden;
            var by_hidden: Hidden;
            hidden_layers(1u + term, x, &h);
            #for j in 0..O
                by_output[term][j] = by_shading[term] * l[j] * logistic(by_output[term][j]);
            #end
            backward(1u + term, &h, by_output[term], &by_hidden);
            var by_input = vec4(0.0);
            #for j in 0..W
                by_input += by_hidden[j] * weights_at((1u + term) * NETWORK + 4u * j);
            #end
            #for k in 0..3
                gradient[place(i, row + k, 7u)] = by_input[k];
            #end
        #end
    }
    sums[t] = loss;
    workgroupBarrier();
    // A grid of two axes may have a few superfluous workgroups.
    if t == 0u && number * 64u < parameters.samples {
        var sum = 0.0;
        for (var s = 0u; s < 64u; s++) {
            sum += sums[s];
        }
        losses[parameters.first_group + number] = parameters.scale * sum;
    }
}
