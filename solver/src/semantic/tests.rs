use glam::Vec3;

use super::*;
use crate::testing;

const LEFT: Vec3 = Vec3::new(0.5, 0.1, 0.1);
const RIGHT: Vec3 = Vec3::new(0.1, 0.2, 0.6);

/// Two regions, left and right; the colour varies inside of them, but not in its mean.
fn two_regions(p: Vec3) -> (Vec3, u8) {
    if p.x < 0.0 { (LEFT, 3) } else { (RIGHT, 5) }
}

fn weights() -> ViewWeightConfig {
    ViewWeightConfig::default()
}

fn initial(views: &[View], size: usize) -> Picture {
    let mesh = testing::dome(24);
    initial_diffuse_albedo(&mesh, views, &GBuffer::of_views(&mesh, views), &weights(), size, &[])
}

fn views() -> Vec<View> {
    let mesh = testing::dome(24);
    testing::rig(3, 48).iter().map(|camera| testing::view(&mesh, camera, two_regions)).collect()
}

#[test]
fn every_region_gets_its_colour_even_where_no_view_sees_it() {
    let albedo = initial(&views(), 32);
    for y in 0..32 {
        for x in (0..14).chain(18..32) {
            let colour = Vec3::from_slice(albedo.pixel(x, y));
            let expected = if x < 16 { LEFT } else { RIGHT };
            assert!((colour - expected).length() < 1e-5, "texel {x}, {y}: {colour}");
        }
    }
    let half: Vec<View> = views().iter().map(View::half).collect();
    let colour = Vec3::from_slice(initial(&half, 32).pixel(8, 16)) - LEFT;
    // A region is ten half pixels wide; the mixed column at its border has half of the other colour.
    let most = (LEFT - RIGHT).length() / 2.0 / 10.0;
    assert!(colour.length() < 1.2 * most, "only the border mixes: {colour}");
}

#[test]
fn labels_that_are_alike_begin_with_the_colour_of_the_largest() {
    let mesh = testing::dome(24);
    let three = |p: Vec3| if p.x < -0.5 { (RIGHT, 7) } else { two_regions(p) };
    let views: Vec<View> =
        testing::rig(3, 48).iter().map(|camera| testing::view(&mesh, camera, three)).collect();
    let gbuffers = GBuffer::of_views(&mesh, &views);
    let initial =
        |alike: &[u8]| initial_diffuse_albedo(&mesh, &views, &gbuffers, &weights(), 32, alike);
    let near = |albedo: &Picture, x: usize, expected: Vec3| {
        (Vec3::from_slice(albedo.pixel(x, 16)) - expected).length() < 1e-5
    };
    let alike = initial(&[7, 3]);
    assert!(near(&alike, 2, LEFT) && near(&alike, 13, LEFT) && near(&alike, 20, RIGHT));
    let apart = initial(&[3, 200]);
    assert!(near(&apart, 2, RIGHT) && near(&apart, 13, LEFT), "a label that no view has is none");
}

#[test]
fn without_labels_the_face_is_one_region() {
    let mut views = views();
    for view in &mut views {
        view.labels = None;
    }
    let albedo = initial(&views, 16);
    let first = Vec3::from_slice(albedo.pixel(0, 0));
    assert!(albedo.data.chunks(3).all(|texel| Vec3::from_slice(texel) == first));
    assert!((first - (LEFT + RIGHT) / 2.0).length() < 0.05, "{first}");
}
