//! A run folder with procedural pictures, for the tests of the report.

use std::fs;
use std::path::Path;

use formats::picture::{self, GrayImage, Picture};
use serde_json::{Value, json};

const SIDE: usize = 96;
const LIGHTS: [&str; 2] = ["flash", "uniform"];
const METHODS: [(&str, &str, f32); 3] =
    [("unshade", "solver", 0.05), ("mean_texture", "baseline", 0.2), ("oracle", "oracle", 0.004)];

/// A shaded ball whose pattern depends on `phase`, off by `error`.
fn ball(phase: f32, error: f32) -> Picture {
    let mut picture = Picture::new(SIDE, SIDE, 3);
    for y in 0..SIDE {
        for x in 0..SIDE {
            let [nx, ny, nz] = normal(x, y);
            let light = (0.5 * nx + 0.4 * ny + 0.7 * nz).max(0.0);
            let paint = 0.5 + 0.2 * (9.0 * nx + phase).sin() * (7.0 * ny).cos();
            let off = 1.0 + error * (11.0 * ny + 5.0 * nx).sin();
            let pixel = [0.8, 0.55, 0.42].map(|c| c * paint * light * off);
            picture.pixel_mut(x, y).copy_from_slice(&pixel);
        }
    }
    picture
}

fn normal(x: usize, y: usize) -> [f32; 3] {
    let scale = |i: usize| (i as f32 + 0.5) / SIDE as f32 * 2.2 - 1.1;
    let (nx, ny) = (scale(x), -scale(y));
    let rest = 1.0 - nx * nx - ny * ny;
    if rest > 0.0 { [nx, ny, rest.sqrt()] } else { [0.0, 0.0, 0.0] }
}

fn normals(error: f32) -> Picture {
    let mut picture = Picture::new(SIDE, SIDE, 3);
    for y in 0..SIDE {
        for x in 0..SIDE {
            let [nx, ny, nz] = normal(x, y);
            let tilt = error * (23.0 * nx).sin();
            picture.pixel_mut(x, y).copy_from_slice(&[nx + tilt, ny, nz + 1e-3]);
        }
    }
    picture
}

fn mask() -> GrayImage {
    let inside = |i: usize| u8::from(normal(i % SIDE, i / SIDE)[2] > 0.0) * 255;
    GrayImage { width: SIDE, height: SIDE, data: (0..SIDE * SIDE).map(inside).collect() }
}

fn grey(error: f32) -> Picture {
    let source = ball(1.0, error);
    let data = source.data.iter().step_by(3).map(|value| value * 0.05).collect();
    Picture { width: SIDE, height: SIDE, channels: 1, data }
}

/// The picture with its layers: nine channels.
fn layered(phase: f32, error: f32) -> Picture {
    let whole = ball(phase, error);
    let mut picture = Picture::new(SIDE, SIDE, 9);
    for y in 0..SIDE {
        for x in 0..SIDE {
            let pixel: Vec<f32> = [1.0, 0.8, 0.2]
                .iter()
                .flat_map(|weight| whole.pixel(x, y).iter().map(move |value| value * weight))
                .collect();
            picture.pixel_mut(x, y).copy_from_slice(&pixel);
        }
    }
    picture
}

const LAYERED: [&str; 9] = [
    "R",
    "G",
    "B",
    "diffuse.R",
    "diffuse.G",
    "diffuse.B",
    "specular.R",
    "specular.G",
    "specular.B",
];

fn save_layered(path: &Path, phase: f32, error: f32) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    picture::write_exr(path, &layered(phase, error), &LAYERED).unwrap();
}

fn save_json(path: &Path, value: &Value) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, serde_json::to_vec_pretty(value).unwrap()).unwrap();
}

fn save_maps(folder: &Path, error: f32, with_normals: bool) {
    fs::create_dir_all(folder).unwrap();
    picture::write_exr_rgb(&folder.join("diffuse_albedo.exr"), &ball(0.0, error)).unwrap();
    picture::write_exr(&folder.join("specular_albedo.exr"), &grey(error), &["Y"]).unwrap();
    if with_normals {
        picture::write_exr_rgb(&folder.join("specular_normal.exr"), &normals(error)).unwrap();
        picture::write_exr_rgb(&folder.join("diffuse_normal.exr"), &normals(error / 2.0)).unwrap();
    }
}

fn save_capture(folder: &Path, light: usize) {
    for sub in ["images", "masks", "truth/layers"] {
        fs::create_dir_all(folder.join(sub)).unwrap();
    }
    let mut frames = Vec::new();
    for index in 0..6 {
        let name = format!("{index:03}");
        let phase = index as f32 + light as f32 * 0.3;
        picture::write_exr_rgb(&folder.join(format!("images/{name}.exr")), &ball(phase, 0.0))
            .unwrap();
        picture::write_png_gray(&folder.join(format!("masks/{name}.png")), &mask()).unwrap();
        save_layered(&folder.join(format!("truth/layers/{name}.exr")), phase, 0.0);
        if index >= 4 {
            for (other, other_name) in LIGHTS.iter().enumerate() {
                let path = folder.join(format!("truth/relit/{other_name}/{name}.exr"));
                save_layered(&path, index as f32 + other as f32 * 0.3, 0.0);
            }
        }
        frames.push(json!({
            "name": name, "file_path": format!("images/{name}.exr"),
            "mask_path": format!("masks/{name}.png"),
            "w": SIDE, "h": SIDE, "fl_x": 90.0, "fl_y": 90.0, "cx": 48.0, "cy": 48.0,
            "transform_matrix": [[1, 0, 0, index as f64 * 0.1], [0, 1, 0, 0], [0, 0, 1, 1], [0, 0, 0, 1]],
        }));
    }
    let names = |range: std::ops::Range<usize>| -> Vec<String> {
        range.map(|index| format!("images/{index:03}.exr")).collect()
    };
    save_json(
        &folder.join("transforms.json"),
        &json!({
            "camera_model": "PINHOLE", "mesh": "mesh.obj", "frames": frames,
            "train_filenames": names(0..4), "test_filenames": names(4..6),
        }),
    );
    let triangle = "v 0 0 0\nv .1 0 0\nv 0 .1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\n\
                    f 1/1/1 2/2/2 3/3/3\n";
    fs::write(folder.join("mesh.obj"), triangle).unwrap();
    save_maps(&folder.join("truth"), 0.0, true);
    picture::write_exr_rgb(&folder.join("truth/light.exr"), &sky(64, 8.0)).unwrap();
    picture::write_png_gray(&folder.join("truth/coverage.png"), &mask()).unwrap();
}

/// A sky with a lamp, latitude over longitude.
fn sky(height: usize, lamp: f32) -> Picture {
    let mut picture = Picture::new(2 * height, height, 3);
    for y in 0..height {
        for x in 0..2 * height {
            let (u, v) = (x as f32 / (2 * height) as f32, y as f32 / height as f32);
            let lit = if (u - 0.35).abs() < 0.08 && (v - 0.3).abs() < 0.12 { lamp } else { 0.0 };
            let pixel = [0.2 + 0.3 * v + lit, 0.3 + 0.2 * v + lit, 0.6 - 0.3 * v + 0.8 * lit];
            picture.pixel_mut(x, y).copy_from_slice(&pixel);
        }
    }
    picture
}

/// Pictures that only our own solver leaves: light, confidence, stages, layers of the training views.
fn save_solve_pictures(maps: &Path, light: usize) {
    picture::write_exr_rgb(&maps.join("light.exr"), &sky(16, 6.0)).unwrap();
    let mut confidence = Picture::new(SIDE, SIDE, 1);
    for (i, value) in confidence.data.iter_mut().enumerate() {
        *value = normal(i % SIDE, i / SIDE)[2].max(0.0);
    }
    picture::write_exr(&maps.join("confidence.exr"), &confidence, &["Y"]).unwrap();
    let mut stated = Picture::new(SIDE, SIDE, 3);
    stated.data.fill(0.02);
    picture::write_exr_rgb(&maps.join("diffuse_albedo_std.exr"), &stated).unwrap();
    for (stage, error) in [("01-warm-up", 0.3), ("02-heights", 0.1)] {
        let folder = maps.join("stages").join(stage);
        fs::create_dir_all(&folder).unwrap();
        picture::write_exr_rgb(&folder.join("diffuse_albedo.exr"), &ball(0.0, error)).unwrap();
        if stage == "02-heights" {
            picture::write_exr_rgb(&folder.join("specular_normal.exr"), &normals(error)).unwrap();
        }
    }
    for index in 0..4 {
        let path = maps.join(format!("layers/{index:03}.exr"));
        save_layered(&path, index as f32 + light as f32 * 0.3, 0.03);
    }
}

fn row(subject: &str, light: Option<&str>, metric: &str, scale: &str, value: f64) -> Value {
    let map = subject.contains("albedo") || subject.contains("normal");
    json!({
        "subject": subject, "metric": metric, "scale": scale,
        "region": if map { "coverage-e5" } else { "mask-e5" }, "label": null, "light": light,
        "value": value, "ci95": [value * 0.98, value * 1.02], "n": 1234, "floor": value * 1.3,
        "per_frame": if map { json!({}) } else { json!({"004": value - 0.5, "005": value + 0.5}) },
    })
}

fn save_scores(path: &Path, method: &str, light: &str, error: f32) {
    let db = f64::from(-20.0 * (error * 0.5).log10());
    let mut rows = vec![
        row("diffuse_albedo", None, "psnr_srgb", "none", db - 1.0),
        row("diffuse_albedo", None, "psnr_srgb", "global", db),
    ];
    if method == "unshade" {
        rows.push(row("confidence", None, "confidence_rank", "global", -0.4));
        rows.push(row("confidence", None, "sparsification", "global", 0.8));
    }
    if method != "mean_texture" {
        rows.push(row("specular_normal", None, "normal_mean_deg", "none", f64::from(error) * 80.0));
        rows.push(row("mesh_specular_normal", None, "normal_mean_deg", "none", 3.5));
        rows.push(row("view", None, "psnr_srgb", "none", db + 4.0));
        rows.push(row("view", None, "ssim", "none", 0.98));
    }
    for (index, light) in LIGHTS.iter().enumerate() {
        rows.push(row("relit", Some(light), "psnr_srgb", "global", db + index as f64));
    }
    let scores = json!({
        "format": 1, "capture": "c", "face": "demo", "light": light, "solver": method,
        "protocol": {"id": "unshade-1", "statements": ["Maps are compared in texture space."]},
        "regions": [{"region": "coverage-e5", "pixels": 5000, "share": 0.9, "solved": null}],
        "inputs": {"capture": "ab".repeat(32), "maps": "cd".repeat(32), "relit": "ef".repeat(32)},
        "scale": {"global": 0.93, "channel": [0.9, 0.9, 0.9], "median": [0.9, 0.9, 0.9]}, "rows": rows,
    });
    save_json(path, &scores);
}

/// Makes the cases of a run whose ids start with `prefix` photographs: without a truth, relit in the light that a
/// method recovers, which only `unshade` does; without the oracle.
pub(super) fn photograph(run: &Path, prefix: &str) {
    let read = |path: &Path| -> Value { serde_json::from_slice(&fs::read(path).unwrap()).unwrap() };
    let mut manifest = read(&run.join("run.json"));
    for case in manifest["cases"].as_array_mut().unwrap() {
        let id = case["id"].as_str().unwrap().to_owned();
        if !id.starts_with(prefix) {
            continue;
        }
        case["light"] = json!("found");
        fs::remove_dir_all(run.join("captures").join(&id).join("truth")).unwrap();
        case["solvers"].as_array_mut().unwrap().retain(|method| method["id"] != "oracle");
        for method in ["unshade", "mean_texture"] {
            let relit = run.join("relit").join(&id).join(method);
            fs::create_dir_all(relit.join("none")).unwrap();
            fs::rename(relit.join("global/uniform"), relit.join("none/even")).unwrap();
            if method == "unshade" {
                fs::rename(relit.join("global/flash"), relit.join("none/found")).unwrap();
            }
            fs::remove_dir_all(relit.join("global")).unwrap();
            let path = run.join(format!("scores/{id}/{method}.json"));
            let mut scores = read(&path);
            (scores["light"], scores["scale"]) = (json!("found"), Value::Null);
            scores["protocol"] =
                json!({"id": "unshade-photographs-1", "statements": ["Unscaled."]});
            scores["rows"] = match method {
                "unshade" => json!([
                    row("view", None, "psnr_srgb", "none", 30.0),
                    row("relit", Some("found"), "psnr_srgb", "none", 28.0),
                ]),
                _ => json!([]),
            };
            for row in scores["rows"].as_array_mut().unwrap() {
                row["floor"] = Value::Null;
            }
            save_json(&path, &scores);
        }
    }
    save_json(&run.join("run.json"), &manifest);
}

/// Writes a run of one face in two lights; the baseline has neither normals nor views.
pub(super) fn write(run: &Path) {
    let mut cases = Vec::new();
    for (index, light) in LIGHTS.iter().enumerate() {
        let case = format!("demo-{light}");
        save_capture(&run.join("captures").join(&case), index);
        let mut solvers = Vec::new();
        for (method, kind, error) in METHODS {
            let below = |folder: &str| format!("{folder}/{case}/{method}");
            let maps = run.join(below("maps"));
            save_maps(&maps, error, method != "mean_texture");
            for frame in 4..6 {
                if method == "unshade" {
                    let path = maps.join(format!("views/{frame:03}.exr"));
                    save_layered(&path, frame as f32 + index as f32 * 0.3, error / 2.0);
                }
                for (other, other_name) in LIGHTS.iter().enumerate() {
                    let path = format!("{}/global/{other_name}/{frame:03}.exr", below("relit"));
                    save_layered(&run.join(path), frame as f32 + other as f32 * 0.3, error);
                }
            }
            if method == "unshade" {
                let losses = |from: f64, count: usize| -> Vec<f64> {
                    (0..count).map(|i| from / (1.0 + i as f64 * 0.02)).collect()
                };
                save_solve_pictures(&maps, index);
                let seconds = json!({"seconds": {"warm-up": 2.0, "fine-tuning": 1.0}});
                save_json(&maps.join("timing.json"), &seconds);
                save_json(
                    &maps.join("solve.json"),
                    &json!({
                        "config": {"name": "fast", "warm_up": {"iterations": 400}}, "seed": 7,
                        "device": "cpu",
                        "stages": [
                            {"name": "warm-up", "loss": losses(0.3, 400)},
                            {"name": "fine-tuning", "loss": losses(0.05, 100)},
                        ],
                    }),
                );
            }
            let scores = format!("{}.json", below("scores"));
            save_scores(&run.join(&scores), method, light, error);
            solvers.push(json!({
                "id": method, "kind": kind, "title": format!("<{method}> & co"),
                "maps": below("maps"), "relit": below("relit"), "scores": scores,
            }));
        }
        cases.push(json!({
            "id": case, "face": "demo", "light": light,
            "capture": format!("captures/{case}"), "solvers": solvers,
        }));
    }
    save_json(
        &run.join("run.json"),
        &json!({
            "format": 1, "suite": "fake", "title": "Two <balls>", "cases": cases,
            "versions": {"unshade": "0.1.0"}, "suite_toml": "format = 1\n",
        }),
    );
    save_json(
        &run.join("timing.json"),
        &json!({"stages": [
            {"id": "capture/demo-flash", "seconds": 12.5, "cached": false},
            {"id": "maps/demo-flash/unshade", "seconds": 3.0, "cached": true},
        ]}),
    );
}
