//! A capture that needs no renderer: a textured plane whose pictures, layers and maps are
//! formulas of its texture coordinates. Not every file of tests uses all of it.

#![allow(dead_code)]

use std::fs;
use std::path::Path;

use formats::picture::{GrayImage, Picture, write_exr, write_png_gray};

use crate::noise::normal_noise;

/// Side of pictures and of the true maps.
pub const SIDE: usize = 96;
/// Half the plane's side, metres.
pub const HALF: f64 = 0.1;
pub const FOCAL: f64 = 320.0;
pub const DISTANCE: f64 = 0.6;
/// Where the cameras stand; the last two views are withheld.
pub const CAMERAS: [[f64; 2]; 5] =
    [[-0.08, 0.0], [0.0, 0.06], [0.08, -0.03], [0.03, 0.0], [-0.04, 0.02]];
const LAYERS: [&str; 12] = [
    "R",
    "G",
    "B",
    "diffuse.R",
    "diffuse.G",
    "diffuse.B",
    "specular.R",
    "specular.G",
    "specular.B",
    "variance.R",
    "variance.G",
    "variance.B",
];

const HALVES: [&str; 3] = ["half.R", "half.G", "half.B"];

pub fn albedo(u: f64, v: f64) -> [f64; 3] {
    let tone = 0.3 + 0.12 * (9.0 * u).sin() * (7.0 * v).cos() + 0.05 * (60.0 * u + 40.0 * v).sin();
    [tone, 0.7 * tone + 0.02, 0.5 * tone + 0.05 * v]
}

pub fn shading(u: f64, v: f64) -> [f64; 3] {
    [0.4 + 0.5 * (3.0 * u + 1.0).sin().powi(2) * (1.0 - 0.5 * v); 3]
}

pub fn specular(u: f64, v: f64) -> [f64; 3] {
    [1.5 * (-30.0 * ((u - 0.6).powi(2) + (v - 0.5).powi(2))).exp(); 3]
}

/// A map of `side` texels, row 0 at v = 1.
pub fn map(side: usize, channels: usize, texture: impl Fn(f64, f64) -> [f64; 3]) -> Picture {
    let mut map = Picture::new(side, side, channels);
    for (i, value) in map.data.iter_mut().enumerate() {
        let (texel, size) = (i / channels, side as f64);
        let (x, y) = ((texel % side) as f64 + 0.5, (texel / side) as f64 + 0.5);
        *value = texture(x / size, 1.0 - y / size)[i % channels] as f32;
    }
    map
}

pub fn write_rgb(path: &Path, picture: &Picture) {
    write_exr(path, picture, &["R", "G", "B"]).unwrap();
}

/// A camera's picture: values of a texture on the plane, black beside it.
fn view(camera: [f64; 2], texture: impl Fn(f64, f64) -> [f64; 3]) -> Picture {
    let mut picture = Picture::new(SIDE, SIDE, 3);
    for y in 0..SIDE {
        for x in 0..SIDE {
            if let Some([u, v]) = uv(camera, x, y) {
                picture.pixel_mut(x, y).copy_from_slice(&texture(u, v).map(|value| value as f32));
            }
        }
    }
    picture
}

/// Cameras look along -z, so that a pixel's ray meets the plane z = 0 at once.
fn uv([left, up]: [f64; 2], x: usize, y: usize) -> Option<[f64; 2]> {
    let centre = SIDE as f64 / 2.0;
    let place = [
        left + (x as f64 + 0.5 - centre) / FOCAL * DISTANCE,
        up - (y as f64 + 0.5 - centre) / FOCAL * DISTANCE,
    ];
    let uv = place.map(|p| (p + HALF) / (2.0 * HALF));
    uv.iter().all(|c| (0.0..=1.0).contains(c)).then_some(uv)
}

/// One rendering of a view with its layers; `noise` times the root of `variance` is added to the
/// total, `gain` multiplies the diffuse layer.
pub fn write_render(
    path: &Path,
    frame: usize,
    variance: f64,
    noise: &mut dyn FnMut() -> f64,
    gain: f64,
) {
    let diffuse = view(CAMERAS[frame], |u, v| {
        let (a, s) = (albedo(u, v), shading(u, v));
        [0, 1, 2].map(|c| gain * a[c] * s[c])
    });
    let highlights = view(CAMERAS[frame], specular);
    let mut layers = Picture::new(SIDE, SIDE, 12);
    for i in 0..SIDE * SIDE {
        for c in 0..3 {
            let (d, s) = (diffuse.data[3 * i + c], highlights.data[3 * i + c]);
            let total = d + s + (variance.sqrt() * noise()) as f32;
            let pixel = &mut layers.data[12 * i..12 * i + 12];
            (pixel[c], pixel[3 + c], pixel[6 + c], pixel[9 + c]) = (total, d, s, variance as f32);
        }
    }
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    write_exr(path, &layers, &LAYERS).unwrap();
}

/// A rendering of two halves of noise, each of twice the `variance` of their mean.
pub fn write_halves(
    path: &Path,
    frame: usize,
    variance: f64,
    noise: &mut dyn FnMut() -> f64,
    gain: f64,
) {
    write_render(path, frame, 0.0, &mut || 0.0, gain);
    let clean = formats::picture::read_exr(path, &LAYERS).unwrap();
    let (layers, channels) = (LAYERS.len(), LAYERS.len() + HALVES.len());
    let mut both = Picture::new(SIDE, SIDE, channels);
    for (pixel, clean) in both.data.chunks_exact_mut(channels).zip(clean.data.chunks_exact(layers))
    {
        pixel[..layers].copy_from_slice(clean);
        for c in 0..3 {
            let half = |n: f64| f64::from(clean[c]) + (2.0 * variance).sqrt() * n;
            let [a, b] = [noise(), noise()].map(half);
            (pixel[c], pixel[layers + c]) = ((0.5 * (a + b)) as f32, a as f32);
        }
    }
    let names: Vec<&str> = LAYERS.into_iter().chain(HALVES).collect();
    write_exr(path, &both, &names).unwrap();
}

/// A complete capture with its truth, lit by `own` and `other`, the pictures with noise.
pub fn write_capture(folder: &Path, variance: f64) {
    for below in ["images", "masks", "labels", "truth/layers"] {
        fs::create_dir_all(folder.join(below)).unwrap();
    }
    fs::write(
        folder.join("mesh.obj"),
        "v -.1 -.1 0\nv .1 -.1 0\nv .1 .1 0\nv -.1 .1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n\
         f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n",
    )
    .unwrap();
    let mut noise = normal_noise(1);
    let mut frames = Vec::new();
    for (i, camera) in CAMERAS.iter().enumerate() {
        let name = format!("{i:03}");
        let on_plane = |x, y| u8::from(uv(*camera, x, y).is_some());
        let gray = |inside: u8| GrayImage {
            width: SIDE,
            height: SIDE,
            data: (0..SIDE * SIDE).map(|p| inside * on_plane(p % SIDE, p / SIDE)).collect(),
        };
        write_png_gray(&folder.join(format!("masks/{name}.png")), &gray(255)).unwrap();
        write_png_gray(&folder.join(format!("labels/{name}.png")), &gray(1)).unwrap();
        write_render(
            &folder.join(format!("truth/layers/{name}.exr")),
            i,
            variance,
            &mut noise,
            1.0,
        );
        write_rgb(&folder.join(format!("images/{name}.exr")), &view(*camera, albedo));
        if i >= 3 {
            for (light, gain) in [("own", 1.0), ("other", 1.3)] {
                let path = folder.join(format!("truth/relit/{light}/{name}.exr"));
                write_render(&path, i, variance, &mut noise, gain);
            }
        }
        frames.push(serde_json::json!({
            "name": name, "file_path": format!("images/{name}.exr"),
            "mask_path": format!("masks/{name}.png"), "label_path": format!("labels/{name}.png"),
            "w": SIDE, "h": SIDE, "fl_x": FOCAL, "fl_y": FOCAL,
            "cx": SIDE as f64 / 2.0, "cy": SIDE as f64 / 2.0,
            "transform_matrix": [[1.0, 0.0, 0.0, camera[0]], [0.0, 1.0, 0.0, camera[1]],
                                 [0.0, 0.0, 1.0, DISTANCE], [0.0, 0.0, 0.0, 1.0]],
        }));
    }
    let paths = |range: std::ops::Range<usize>| -> Vec<String> {
        range.map(|i| format!("images/{i:03}.exr")).collect()
    };
    let transforms = serde_json::json!({
        "camera_model": "PINHOLE", "mesh": "mesh.obj", "frames": frames,
        "train_filenames": paths(0..3), "test_filenames": paths(3..5),
    });
    fs::write(folder.join("transforms.json"), transforms.to_string()).unwrap();
    write_truth(&folder.join("truth"));
}

fn write_truth(truth: &Path) {
    write_rgb(&truth.join("diffuse_albedo.exr"), &map(SIDE, 3, albedo));
    let specular_albedo = map(SIDE, 1, |u, v| [0.02 + 0.02 * (5.0 * u).sin() * (4.0 * v).cos(); 3]);
    write_exr(&truth.join("specular_albedo.exr"), &specular_albedo, &["Y"]).unwrap();
    let roughness = map(SIDE, 3, |_, _| [0.15, 0.35, 0.5]);
    write_exr(&truth.join("roughness.exr"), &roughness, &["alpha1", "alpha2", "share1"]).unwrap();
    // Tilted by 6 and 3 degrees: the plain mesh normal is off by just that.
    for (name, degrees) in [("specular_normal.exr", 6.0_f64), ("diffuse_normal.exr", 3.0)] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        write_rgb(&truth.join(name), &map(SIDE, 3, |_, _| [sin, 0.0, cos]));
    }
    let gray = |name: &str, value: &dyn Fn(usize) -> u8| {
        let data = (0..SIDE * SIDE).map(value).collect();
        write_png_gray(&truth.join(name), &GrayImage { width: SIDE, height: SIDE, data }).unwrap();
    };
    gray("coverage.png", &|_| 255);
    gray("labels.png", &|i| if i % SIDE < SIDE / 3 { 2 } else { 1 });
    gray("views.png", &|i| if i / SIDE < 8 { 1 } else { 3 });
    let scene = "format = 1\nname = \"plane\"\n[face]\nname = \"flat\"\n[light]\nname = \"own\"\n";
    fs::write(truth.join("scene.toml"), scene).unwrap();
}
