//! Metrics where there is nothing to measure, or nothing to measure with.

#![allow(clippy::unwrap_used)]

use formats::picture::{GrayImage, Picture};
use scoring::metrics::{Metric, MetricError, Pair, Region, Scale};

fn picture(channels: usize, value: impl Fn(usize) -> f32) -> Picture {
    let data = (0..8 * 8 * channels).map(value).collect();
    Picture { width: 8, height: 8, channels, data }
}

fn whole() -> Region {
    Region::whole(8, 8).unwrap()
}

#[test]
fn an_empty_region_is_an_error_that_names_it() {
    let thin = GrayImage {
        width: 8,
        height: 8,
        data: (0..64).map(|i| if i < 32 { 255 } else { 0 }).collect(),
    };
    let error = Region::eroded("mask-e5", &thin).unwrap_err();
    assert_eq!(error, MetricError::EmptyRegion { region: "mask-e5".to_owned() });
    assert!(whole().part("nose", |_| false).is_err());
    assert!(Region::of_mask("mask", &thin).is_ok());
}

#[test]
fn pictures_that_cannot_be_compared_are_refused_with_their_place() {
    let (good, region) = (picture(3, |_| 0.5), whole());
    let mut broken = good.clone();
    broken.pixel_mut(3, 2)[1] = f32::NAN;
    let message = |result: Result<Pair, MetricError>| result.unwrap_err().to_string();
    assert!(
        message(Pair::new(&broken, &good, &region))
            .contains("prediction is NaN at column 3, row 2, channel 1")
    );
    assert!(message(Pair::new(&good, &broken, &region)).contains("truth is NaN"));
    let outside = region.part("rest", |i| i != 2 * 8 + 3).unwrap();
    assert!(Pair::new(&broken, &good, &outside).is_ok(), "a masked pixel does not matter");
    assert!(
        message(Pair::new(&Picture::new(4, 8, 3), &good, &region))
            .contains("prediction is 4x8, the truth 8x8")
    );
    assert!(message(Pair::new(&picture(1, |_| 0.5), &good, &region)).contains("found 1"));
    let gray = picture(1, |_| 0.5);
    let values = Pair::new(&gray, &gray, &region).unwrap();
    for id in ["flip_mean", "normal_mean_deg", "ciede2000_mean", "ita_error"] {
        let error = Metric::find(id).unwrap().value(&values).unwrap_err().to_string();
        assert!(error.contains(id) && error.contains("3 channels, found 1"), "{error}");
    }
    let colours = Pair::new(&good, &good, &region).unwrap();
    for (id, input) in
        [("wcorr", "labels"), ("leakage_shading", "shading"), ("leakage_specular", "specular")]
    {
        let error = Metric::find(id).unwrap().value(&colours).unwrap_err().to_string();
        assert!(error.contains(id) && error.contains(input), "{error}");
    }
}

#[test]
fn constants_have_no_correlation_and_black_no_scale() {
    let (flat, ramp, region) = (picture(1, |_| 0.02), picture(1, |i| i as f32 * 0.01), whole());
    for (a, b) in [(&flat, &ramp), (&ramp, &flat)] {
        let pair = Pair::new(a, b, &region).unwrap();
        for id in ["pearson", "spearman", "hc"] {
            assert_eq!(Metric::find(id).unwrap().value(&pair).unwrap(), None, "{id}");
        }
    }
    let (black, grey) = (picture(3, |_| 0.0), picture(3, |_| 0.5));
    let pair = Pair::new(&black, &grey, &region).unwrap();
    let error = Scale::fit(&pair).unwrap_err();
    assert_eq!(error, MetricError::NoScale { region: "whole".to_owned() });
    assert_eq!(Metric::find("scale_global").unwrap().value(&pair).unwrap(), None);
    let angle = Metric::find("normal_mean_deg").unwrap().value(&pair).unwrap();
    assert_eq!(angle, Some(90.0), "a vector without length points nowhere");
}
