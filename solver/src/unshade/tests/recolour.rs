//! Colours of regions other than skin under a known light.

use capture::gbuffer::Atlas;

use super::*;
use crate::test_scene::REGIONS;
use crate::unshade::recolour::recoloured;

/// Light that falls off to one side: on an unoccluded surface its irradiance is pi (1 + 2/3 a n).
const FALL: Vec3 = Vec3::new(0.9, 0.0, 0.0);

#[test]
fn under_a_known_light_hair_in_the_shade_gets_its_own_colour_and_skin_stays() {
    let folder = tempfile::tempdir().unwrap();
    let shade = |p: Vec3| {
        let (label, albedo) = region(p);
        (albedo * (1.0 + 2.0 / 3.0 * FALL.dot(p.normalize())), label)
    };
    let mesh = testing::dome(24);
    let views: Vec<View> =
        testing::rig(6, 128).iter().map(|camera| testing::view(&mesh, camera, shade)).collect();
    testing::write_capture(folder.path(), &mesh, &views, 1);
    let capture = Capture::open(folder.path()).unwrap();
    let mut config = small();
    config.transport.bounces = 0;
    config.transport.texture_size = 128;
    config.regions.hair_in_skin = false;
    let (size, rows) = (config.transport.texture_size, config.transport.rows);
    let luminance = Some(config.rendering.exposure);
    let scene =
        Scene::new(&capture, SampleSpace::default(), luminance, config.maps.texture_size).unwrap();
    let face = FaceRegions::new(&scene, &config);
    let regions = face.region_map(&scene, size);
    let before = face.mean_colours(&scene, &regions);
    let transport = Transport::new(&mesh, &Sky::lat_long(rows), &config.transport, 0);
    let cells = Sky::lat_long(rows).centres();
    let estimate = JointEstimate {
        log_light: cells.iter().flat_map(|w| [(1.0 + FALL.dot(*w)).ln(); 3]).collect(),
        albedo: before.clone(),
        nearness_per_metre: 0.0,
        terms: RegionTerms::prior(0.0, &face.skin, &regions),
    };
    let data = LightFitData {
        known: Known::new(&capture.truth, scene.picture_scale),
        illuminations: &Illuminations::one(),
        samples: &scene.samples_at_half_resolution(None, size),
        face: &face,
        regions: &regions,
        region_colours: &before,
    };
    let after = recoloured(&Cpu::new(), &config.skin, &transport, &data, estimate).albedo;
    let atlas = Atlas::new(&mesh, size);
    let of = |albedo: &[f32], label: u8| -> Vec<Vec3> {
        let inside = (0..atlas.positions.len()).filter(|at| {
            let p = atlas.positions[*at];
            let around = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y].map(|d| p + 0.1 * d);
            atlas.inside[*at] && p.z > 0.3 && around.iter().all(|p| region(*p).0 == label)
        });
        inside.map(|at| Vec3::from_slice(&albedo[3 * at..])).collect()
    };
    let [(skin, _), _, (shaded, albedo)] = REGIONS;
    let error = |texels: &[Vec3]| {
        let of_texel = |a: &Vec3| (*a / (scene.picture_scale * albedo) - 1.0).abs().max_element();
        texels.iter().map(of_texel).fold(0.0, f32::max)
    };
    let [first, last] = [&before, &after].map(|albedo| error(&of(albedo, shaded)));
    assert!(first > 0.2 && last < 0.05, "error {first}, then {last}");
    assert!(of(&before, skin).len() > 50);
    assert!(of(&before, skin) == of(&after, skin), "skin has changed");
}
