// The pixel model A_d S_d + F A_s S_s against its target, and its gradients; see backend/cpu/shade.rs.

struct Pixel {
    // weight x |residual|, summed over the channels.
    loss: f32,
    by_diffuse: f32,
    by_specular: f32,
    by_albedo: vec4<f32>,
}

// `pixels` has the rows Fresnel factor, target R, G, B, weight; `scale` is one over the terms of the mean.
fn shaded(i: u32, albedo: vec4<f32>, diffuse: f32, specular: f32, scale: f32) -> Pixel {
    let fresnel = pixels[place(i, 0u, 5u)];
    let target_colour = vec3(
        pixels[place(i, 1u, 5u)], pixels[place(i, 2u, 5u)], pixels[place(i, 3u, 5u)]);
    let weight = pixels[place(i, 4u, 5u)];
    let strength = fresnel * albedo.w;
    let residual = albedo.xyz * diffuse + strength * specular - target_colour;
    let push = weight * scale * sign(residual);
    let all = push.x + push.y + push.z;
    var out: Pixel;
    out.loss = weight * (abs(residual.x) + abs(residual.y) + abs(residual.z));
    out.by_diffuse = dot(push, albedo.xyz);
    out.by_specular = all * strength;
    out.by_albedo = vec4(push * diffuse, all * fresnel * specular);
    return out;
}
