//! The specular reflection of skin: two GGX lobes with Smith's masking (Walter et al. 2007, equations 33 and 34)
//! under Schlick's term. Its parameters are [`SkinConfig`]; `wgsl/skin_highlights.wgsl` has the same for a GPU, and
//! `skin_bsdf.py` for Mitsuba. Tests compare both with this file.

use glam::Vec3;

use crate::config::SkinConfig;

/// Least cosine between normal and view in a division.
pub(super) const GRAZING: f32 = 1e-3;

/// Schlick's approximation, equation (1).
pub fn schlick(f0: f32, cosine: f32) -> f32 {
    f0 + (1.0 - f0) * (1.0 - cosine.clamp(0.0, 1.0)).powi(5)
}

/// BRDF of skin whose reflectance at normal incidence is `skin.f0`, times the cosine of the light, 1/sr; all
/// directions unit, from the surface. 0 if the light is behind it.
pub fn reflected(skin: &SkinConfig, normal: Vec3, view: Vec3, light: Vec3) -> f32 {
    let (towards_view, towards_light) = (normal.dot(view).max(GRAZING), normal.dot(light));
    if towards_light <= 0.0 {
        return 0.0;
    }
    let half = (view + light).normalize();
    let cosine = normal.dot(half);
    let lobe = |(roughness, weight): (f32, f32)| {
        let squared = roughness * roughness;
        let smith = |c: f32| 2.0 * c / (c + (squared + (1.0 - squared) * c * c).sqrt());
        let spread = cosine * cosine * (squared - 1.0) + 1.0;
        let density = squared * std::f32::consts::FRAC_1_PI / (spread * spread);
        weight * density * smith(towards_view) * smith(towards_light)
    };
    let lobes = skin.lobes().into_iter().map(lobe).sum::<f32>();
    lobes / (4.0 * towards_view) * schlick(skin.f0, view.dot(half))
}

/// [`reflected`] over Schlick's term, and its derivatives with respect to n.h, n.v and n.l, in a form that compilers
/// vectorise: with r(x) for the root in Smith's term 2 x / (x + r(x)), a lobe is
/// D(n.h) / (2 (n.v + r(n.v))) x 2 n.l / (n.l + r(n.l)).
#[inline(always)]
pub(super) fn lobe_slopes(skin: &SkinConfig, nh: f32, nv: f32, nl: f32) -> [f32; 4] {
    let [mut value, mut by_nh, mut by_nv, mut by_nl] = [0.0f32; 4];
    for (roughness, weight) in skin.lobes() {
        let a = roughness * roughness;
        let spread = 1.0 / (nh * nh * (a - 1.0) + 1.0);
        let d = weight * a * std::f32::consts::FRAC_1_PI * spread * spread;
        let [rv, rl] = [nv, nl].map(|x| (a + (1.0 - a) * x * x).sqrt());
        let [iv, il] = [1.0 / (nv + rv), 1.0 / (nl + rl)];
        let lobe = d * iv * il;
        value += lobe * nl;
        by_nh += lobe * nl * 4.0 * nh * (1.0 - a) * spread;
        by_nv -= lobe * nl * iv * (1.0 + (1.0 - a) * nv / rv);
        by_nl += lobe * il * a / rl;
    }
    [value, by_nh, by_nv, by_nl]
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;
    use crate::config::UnshadeConfig;

    fn skin() -> SkinConfig {
        UnshadeConfig::default().skin
    }

    /// The share of a uniform light of radiance 1 that is reflected to a view.
    fn under_a_dome(cosine: f32) -> f32 {
        let (skin, view) = (skin(), Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine));
        let (rings, sectors) = (400, 400);
        let mut sum = 0.0;
        for ring in 0..rings {
            let z = (ring as f32 + 0.5) / rings as f32;
            for sector in 0..sectors {
                let (sine, cosine) = (2.0 * PI * (sector as f32 + 0.5) / sectors as f32).sin_cos();
                let radius = (1.0 - z * z).sqrt();
                let light = Vec3::new(radius * cosine, radius * sine, z);
                sum += reflected(&skin, Vec3::Z, view, light);
            }
        }
        sum * 2.0 * PI / (rings * sectors) as f32
    }

    #[test]
    fn skin_reflects_its_reflectance_from_the_front_and_more_at_a_slant_but_never_all() {
        let front = under_a_dome(1.0);
        // Light that meets facets twice is not followed: a tenth is lost.
        assert!((0.88..1.0).contains(&(front / skin().f0)), "{front}");
        let slanting = under_a_dome(0.3);
        assert!(slanting > 2.0 * front, "{slanting} against {front}");
        assert!((1..10).all(|tenth| under_a_dome(0.1 * tenth as f32) < 1.0));
    }

    #[test]
    fn light_and_view_can_be_exchanged() {
        let (a, b) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.2, 0.4, 0.9).normalize());
        // The value holds the cosine of the light.
        let there = reflected(&skin(), Vec3::Z, a, b) / b.z;
        let back = reflected(&skin(), Vec3::Z, b, a) / a.z;
        assert!((there - back).abs() < 1e-5 * there, "{there} {back}");
    }

    #[test]
    fn both_forms_of_the_lobes_have_one_value() {
        let view = Vec3::new(0.6, 0.0, 0.8);
        for i in 0..100 {
            let (azimuth, z) = (i as f32 * 2.4, (i as f32 + 0.5) / 100.0);
            let radius = (1.0 - z * z).sqrt();
            let light = Vec3::new(radius * azimuth.cos(), radius * azimuth.sin(), z);
            let half = (view + light).normalize();
            let [lobes, ..] = lobe_slopes(&skin(), half.z, view.z, light.z);
            let (found, expected) = (
                lobes * schlick(skin().f0, view.dot(half)),
                reflected(&skin(), Vec3::Z, view, light),
            );
            assert!((found - expected).abs() < 1e-5 * expected, "{found} {expected}");
        }
    }
}
