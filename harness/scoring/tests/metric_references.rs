//! Every metric against an independent implementation (scikit-image, colour-science, SciPy,
//! flip-evaluator): `reference/metrics.py` makes the same pictures and records the values.

use formats::picture::{GrayImage, Picture};
use scoring::metrics::{METRICS, Metric, Pair, Protocol, Quantity, Region, Scale, black_outside};
use serde_json::Value;

const WIDTH: usize = 96;
const HEIGHT: usize = 64;

fn triangle(position: usize, period: usize) -> f64 {
    ((position % period) as f64 / period as f64 * 2.0 - 1.0).abs()
}

fn noise(x: usize, y: usize, seed: usize) -> f64 {
    let state = (x * 7919 + y * 104_729 + seed * 15_485_863) % 65521;
    (state * state % 65521) as f64 / 65521.0
}

fn picture(channels: usize, value: impl Fn(usize, usize, usize) -> f32) -> Picture {
    let mut picture = Picture::new(WIDTH, HEIGHT, channels);
    for (i, out) in picture.data.iter_mut().enumerate() {
        let pixel = i / channels;
        *out = value(pixel % WIDTH, pixel / WIDTH, i % channels);
    }
    picture
}

fn gray(value: impl Fn(usize, usize) -> u8) -> GrayImage {
    let data = (0..WIDTH * HEIGHT).map(|i| value(i % WIDTH, i / WIDTH)).collect();
    GrayImage { width: WIDTH, height: HEIGHT, data }
}

struct Pictures {
    truth: Picture,
    prediction: Picture,
    cause: Picture,
    true_normal: Picture,
    normal: Picture,
    mask: GrayImage,
    labels: GrayImage,
    confidence: Picture,
}

fn pictures() -> Pictures {
    let shade = |x, y, c| 0.3 + 0.9 * triangle(x + 2 * y + 5 * c, 101);
    let albedo = |x, y, c| {
        let base = 0.06 + 0.5 * triangle(x * (c + 2) + 3 * y, 67) * triangle(y * 2 + c * 11, 53);
        base + 0.02 * noise(x, y, c)
    };
    let highlight =
        |x: usize, y: usize| f32::from(u8::from((30..33).contains(&y) && (40..44).contains(&x)));
    let normal = |x, y, c| match c {
        0 => (triangle(x, 37) - 0.5) as f32,
        1 => (triangle(y, 29) - 0.5) as f32,
        _ => 1.0,
    };
    Pictures {
        truth: picture(3, |x, y, c| albedo(x, y, c) as f32 + highlight(x, y)),
        prediction: picture(3, |x, y, c| {
            let baked = 0.8 + 0.2 * shade(x, y, c);
            (0.9 * albedo(x, y, c) * baked + 0.05 * noise(x, y, c + 7) - 0.01) as f32
        }),
        cause: picture(3, |x, y, c| shade(x, y, c) as f32),
        true_normal: picture(3, normal),
        normal: picture(3, |x, y, c| {
            (f64::from(normal(x, y, c) * 2.0) + 1.8 * (noise(x, y, c + 1) - 0.5)) as f32
        }),
        mask: gray(|x, y| {
            if x.abs_diff(48).pow(2) * 4 + y.abs_diff(32).pow(2) * 9 < 8000 { 255 } else { 0 }
        }),
        labels: gray(|x, y| (1 + x / 32 + 3 * (y / 40)) as u8),
        confidence: picture(1, |x, y, _| (triangle(x + 2 * y, 101) + 0.3 * noise(x, y, 11)) as f32),
    }
}

fn channel(of: &Picture, channel: usize) -> Picture {
    picture(1, |x, y, _| of.pixel(x, y)[channel])
}

/// How far a value may be from its reference. The metrics are computed in 64 bits and agree to
/// rounding. FLIP is single precision on both sides; 4e-6 (mean) and 2.4e-5 (percentile) apart.
fn tolerance(metric: &Metric) -> f64 {
    match metric.quantity {
        Quantity::Flip => 5e-5,
        // Two searches for the same least error stop at their own last digits.
        Quantity::Compatible(Protocol::ObjectsWithLighting) => 1e-4,
        _ => 1e-9,
    }
}

#[test]
fn every_metric_agrees_with_an_independent_implementation() {
    let stored: Value = serde_json::from_str(include_str!("reference/metrics.json")).unwrap();
    let p = pictures();
    let region = Region::eroded("mask-e5", &p.mask).unwrap();
    assert_eq!(region.pixels().len() as u64, stored["pixels"].as_u64().unwrap());
    let (truth, prediction) =
        (black_outside(&p.truth, &p.mask), black_outside(&p.prediction, &p.mask));
    let (true_value, value) = (channel(&p.truth, 0), channel(&p.prediction, 1));
    let deviation = picture(3, |x, y, c| p.cause.pixel(x, y)[c] * 0.0625);
    let colours = Pair::new(&prediction, &truth, &region)
        .and_then(|pair| pair.with_labels(&p.labels))
        .and_then(|pair| pair.with_cause(&p.cause))
        .and_then(|pair| pair.with_confidence(&p.confidence))
        .and_then(|pair| pair.with_area(&p.confidence))
        .and_then(|pair| pair.with_deviation(&deviation))
        .unwrap();
    let mesh = picture(3, |x, y, c| {
        if (x + y) % 2 == 0 { p.true_normal.pixel(x, y)[c] } else { f32::from(u8::from(c == 2)) }
    });
    let normals = Pair::new(&p.normal, &p.true_normal, &region)
        .and_then(|pair| pair.with_cause(&mesh))
        .and_then(|pair| pair.with_area(&p.confidence))
        .unwrap();
    // Halves of the samples: the pictures with noise of the same size, opposite in the other half.
    let shaken = |of: &Picture, seed: usize| {
        picture(3, |x, y, c| {
            (f64::from(of.pixel(x, y)[c]) + 0.02 * (noise(x, y, seed + c) - 0.5)) as f32
        })
    };
    let halves = [shaken(&p.prediction, 21), shaken(&p.truth, 31)];
    let split = Pair::new(&p.prediction, &p.truth, &region)
        .and_then(|pair| pair.with_halves(&halves[0], &halves[1]))
        .unwrap();
    let values = Pair::new(&value, &true_value, &region).unwrap();
    let mask = Region::of_mask("mask", &p.mask).unwrap();
    let whole = Pair::new(&prediction, &truth, &mask).unwrap();
    for metric in METRICS.iter().filter(|metric| metric.quantity != Quantity::Perceptual) {
        let pair = match metric.id {
            "rmse" | "pearson" | "spearman" | "log_ratio_rms" => &values,
            "relief_invented" | "direction_mean_deg" => &normals,
            "owl_psnr" | "nerfactor_albedo_psnr" => &whole,
            id if id.ends_with("_unbiased") => &split,
            id if id.starts_with("normal") => &normals,
            _ => &colours,
        };
        let found = metric.value(pair).unwrap().unwrap();
        let expected = stored["values"][metric.id].as_f64().unwrap();
        let error = (found - expected).abs();
        println!("{:20} {found:.9} {error:.1e}", metric.id);
        assert!(error <= tolerance(metric), "{}: {found}, reference {expected}", metric.id);
    }
    let scale = Scale::fit(&colours).unwrap();
    for c in 0..3 {
        let expected = |mode: &str| stored["scale"][mode][c].as_f64().unwrap();
        assert!((scale.channel[c] - expected("channel")).abs() < 1e-12);
        assert!((scale.median[c] - expected("median")).abs() < 1e-12);
    }
}
