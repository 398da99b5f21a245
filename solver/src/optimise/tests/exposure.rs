//! The exposure of a capture.

use super::*;

/// Maps of a capture without labels whose pictures are `factor` times as bright.
fn maps(factor: f32) -> Maps {
    let folder = tempfile::tempdir().unwrap();
    let views: Vec<View> = views(5, 32)
        .into_iter()
        .map(|mut view| {
            view.labels.iter_mut().for_each(|labels| labels.data.fill(0));
            view.image.data.iter_mut().for_each(|value| *value *= factor);
            view
        })
        .collect();
    testing::write_capture(folder.path(), &testing::dome(16), &views, 1);
    let capture = Capture::open(folder.path()).unwrap();
    let mut config = small();
    config.colour_regions.count = 0;
    config.warm_up.iterations = 50;
    config.height.steps = 10;
    solve(&capture, &config, &mut silent).unwrap().maps
}

#[test]
fn pictures_four_times_as_bright_show_four_times_the_albedo_and_nothing_else() {
    let [once, brighter] = [1.0, 4.0].map(maps);
    let data = |picture: &Option<formats::picture::Picture>| picture.clone().unwrap().data;
    let expected: Vec<f32> = data(&once.diffuse_albedo).iter().map(|value| 4.0 * value).collect();
    assert!(expected.iter().any(|value| *value > 0.5));
    assert_eq!(data(&brighter.diffuse_albedo), expected);
    assert_eq!(data(&brighter.specular_normal), data(&once.specular_normal));
    assert_eq!(data(&brighter.specular_albedo), data(&once.specular_albedo));
}
