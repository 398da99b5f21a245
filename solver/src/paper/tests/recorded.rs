//! The stages of `paper` against the same stages in PyTorch, step by step. The record and the
//! script that made it are in `solver/tests/pytorch`.

use std::collections::HashMap;
use std::path::Path;

use capture::Mesh;
use formats::picture::{GrayImage, Picture};
use serde::Deserialize;

use super::*;
use crate::backend::cpu::Level;

/// Relative tolerance of every loss. PyTorch's single and double precision differ by a tenth of it.
const TOLERANCE: f64 = 1e-5;
/// Steps have a length of 1e-3, which Adam makes of the faintest gradients, too. One parameter in
/// a hundred may have such a one, whose sign is rounding; the others must stay together.
const PARAMETER_TOLERANCE: f32 = 1e-6;
/// Share of the parameters that must be within [`PARAMETER_TOLERANCE`].
const SHARE: f64 = 0.99;
/// Pictures and focal length of the script's scene.
const PICTURE: usize = 22;
const FOCAL: f32 = 2.6 * PICTURE as f32 / 2.0;

#[derive(Deserialize)]
struct StageRecord {
    kind: String,
    from: usize,
    to: serde_json::Value,
    losses: Vec<f64>,
}

struct Recorded {
    arrays: HashMap<String, Vec<f32>>,
    notes: HashMap<String, String>,
}

impl Recorded {
    /// A safetensors file of float32 arrays.
    fn open() -> Self {
        #[derive(Deserialize)]
        struct Entry {
            data_offsets: [usize; 2],
        }
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pytorch/recorded.safetensors");
        let bytes = std::fs::read(path).unwrap();
        let (length, rest) = bytes.split_first_chunk::<8>().unwrap();
        let (header, content) = rest.split_at(u64::from_le_bytes(*length) as usize);
        let mut header: serde_json::Map<String, serde_json::Value> =
            serde_json::from_slice(header).unwrap();
        let notes = serde_json::from_value(header.remove("__metadata__").unwrap()).unwrap();
        let array = |(name, entry): (String, serde_json::Value)| {
            let [first, last] = serde_json::from_value::<Entry>(entry).unwrap().data_offsets;
            let values = content[first..last].as_chunks::<4>().0;
            (name, values.iter().map(|value| f32::from_le_bytes(*value)).collect())
        };
        Self { arrays: header.into_iter().map(array).collect(), notes }
    }

    fn note<T: serde::de::DeserializeOwned>(&self, name: &str) -> T {
        serde_json::from_str(&self.notes[name]).unwrap()
    }

    fn vectors(&self, name: &str) -> Vec<Vec3> {
        self.arrays[name].chunks_exact(3).map(Vec3::from_slice).collect()
    }

    /// `paper`, apart from what the record had to choose.
    fn config(&self) -> PaperConfig {
        let mut config = PaperConfig::default();
        config.warm_up.prior = self.note("prior");
        config.fine_tuning.deviation_blur = self.note("deviation_blur");
        config
    }

    /// The pictures with what is behind their pixels.
    fn views(&self) -> (Vec<View>, Vec<GBuffer>) {
        let (positions, normals) = (self.vectors("position"), self.vectors("normal"));
        let (view_dirs, colours) = (self.vectors("view"), self.vectors("colour"));
        let uvs = self.arrays["uv"].as_chunks::<2>().0;
        let one = |number: usize| {
            let chosen: Vec<usize> = (0..positions.len())
                .filter(|i| self.arrays["number"][*i] == number as f32)
                .collect();
            let of = |values: &[Vec3]| chosen.iter().map(|i| values[*i]).collect();
            let gbuffer = GBuffer {
                width: PICTURE,
                height: PICTURE,
                focal: FOCAL,
                pixels: chosen.iter().map(|i| self.arrays["pixel"][*i] as u32).collect(),
                positions: of(&positions),
                normals: of(&normals),
                view_dirs: of(&view_dirs),
                uvs: chosen.iter().map(|i| Vec2::from_array(uvs[*i])).collect(),
                depths: chosen.iter().map(|i| self.arrays["depth"][*i]).collect(),
            };
            let mut view = View {
                camera: testing::camera("unused", Vec3::Z, PICTURE),
                image: Picture::new(PICTURE, PICTURE, 3),
                mask: GrayImage::new(PICTURE, PICTURE),
                labels: None,
            };
            for (pixel, i) in gbuffer.pixels.iter().zip(&chosen) {
                let at = 3 * *pixel as usize;
                view.image.data[at..at + 3].copy_from_slice(&colours[*i].to_array());
            }
            (view, gbuffer)
        };
        (0..3).map(one).unzip()
    }

    /// The samples for textures of side `size`.
    fn samples(&self, config: &PaperConfig, size: usize) -> Samples {
        let positions = self.vectors("position");
        let mesh = Mesh { positions, normals: vec![], uvs: vec![], triangles: vec![] };
        let (views, gbuffers) = self.views();
        let space = sample_space(&mesh, config);
        space.training(&views, &gbuffers, config.depth_weights(), size)
    }

    fn fields(&self, name: &str) -> ShadingFields {
        let texture = |key: &str| self.arrays[&format!("{name}.{key}")].clone();
        let diffuse = texture("diffuse");
        let networks = if name == "0" { "0.networks" } else { "warm.networks" };
        ShadingFields {
            networks: Networks {
                shape: vec![3, 16, 16, 8],
                parameters: self.arrays[networks].clone(),
            },
            size: (diffuse.len() / 3).isqrt(),
            diffuse,
            specular: texture("specular"),
            deviation: texture("deviation"),
        }
    }
}

/// Share of the values that are within the tolerance.
fn share_within(values: &[f32], expected: &[f32]) -> f64 {
    assert_eq!(values.len(), expected.len());
    let near = values.iter().zip(expected).filter(|(a, b)| (*a - *b).abs() <= PARAMETER_TOLERANCE);
    near.count() as f64 / values.len() as f64
}

/// Runs every stage; the first disagreement with the record.
fn disagreement(recorded: &Recorded, config: &PaperConfig, level: Level) -> Option<String> {
    let backend = &Cpu::at(level);
    for (number, stage) in recorded.note::<Vec<StageRecord>>("stages").iter().enumerate() {
        let fields = recorded.fields(&stage.from.to_string());
        let samples = &recorded.samples(config, fields.size);
        let deviation = &Deviation::new(config, fields.size);
        let what = format!("{level}, stage {number} ({})", stage.kind);
        let mut fault = None;
        let mut run = |fit: &mut dyn Fit| {
            for (step, expected) in stage.losses.iter().enumerate() {
                let loss = fit.step(backend, 1.0);
                if (loss / expected - 1.0).abs() > TOLERANCE {
                    fault = Some(format!("{what}, step {step}: loss {loss} instead of {expected}"));
                    return;
                }
            }
        };
        let state = match stage.kind.as_str() {
            "warm_up" => {
                let mut fit = WarmUp::new(config, samples, fields);
                run(&mut fit);
                fit.fields
            }
            "relief" => {
                let mut fit = Normals::new(config, samples, deviation, &fields, backend);
                run(&mut fit);
                let Relief { deviation, specular } = fit.relief;
                ShadingFields { deviation, specular, ..fields.clone() }
            }
            _ => {
                let mut fit = diffuse(config, samples, deviation, &fields, backend);
                run(&mut fit);
                ShadingFields { diffuse: fit.albedo, ..fields }
            }
        };
        if fault.is_some() {
            return fault;
        }
        let expected = recorded.fields(stage.to.to_string().trim_matches('"'));
        let parts = [
            ("networks", &state.networks.parameters, &expected.networks.parameters),
            ("diffuse", &state.diffuse, &expected.diffuse),
            ("specular", &state.specular, &expected.specular),
            ("deviation", &state.deviation, &expected.deviation),
        ];
        for (name, values, expected) in parts {
            let share = share_within(values, expected);
            if share < SHARE {
                return Some(format!("{what}: only {share:.3} of the {name} values agree"));
            }
        }
    }
    None
}

#[test]
fn every_stage_has_the_losses_and_the_results_of_pytorch() {
    let recorded = Recorded::open();
    let stages: Vec<StageRecord> = recorded.note("stages");
    assert!(stages.len() == 5 && stages[0].kind == "warm_up" && stages[0].losses.len() == 50);
    for level in Level::available() {
        assert_eq!(disagreement(&recorded, &recorded.config(), level), None);
    }
}

/// Power of the comparison: it finds every one of these faults.
#[test]
fn the_record_finds_small_faults() {
    type Fault = fn(&mut PaperConfig);
    let faults: [(&str, Fault); 13] = [
        ("no Fresnel factor", |c| c.rendering.fresnel = false),
        ("another F0", |c| c.skin.f0 = 0.041),
        ("another prior", |c| c.warm_up.prior *= 1.001),
        ("a prior in the fine-tuning", |c| c.fine_tuning.prior = 1e-3),
        ("normals of the other sign", |c| c.networks.normal_scale = -1.0),
        ("reflections of the other sign", |c| c.networks.reflection_scale = -1.0),
        ("positions of another scale", |c| c.networks.position_scale = 1.0001),
        ("weights without the depth", |c| c.view_weights.depth = false),
        ("another epsilon", |c| c.adam.epsilon = 1e-7),
        ("another decay", |c| c.adam.beta2 = 0.9991),
        ("another rate", |c| c.warm_up.specular_rate = 1.01e-3),
        ("another range of the deviation", |c| c.fine_tuning.deviation_range = 0.501),
        ("another blur", |c| c.fine_tuning.deviation_blur *= 1.01),
    ];
    let recorded = Recorded::open();
    let level = *Level::available().last().unwrap();
    for (what, fault) in faults {
        let mut config = recorded.config();
        fault(&mut config);
        assert!(disagreement(&recorded, &config, level).is_some(), "{what} goes unnoticed");
    }
}

/// The textures grow as in PyTorch between warm-up and fine-tuning.
#[test]
fn textures_are_resized_as_in_pytorch() {
    let recorded = Recorded::open();
    let expected = recorded.fields("1");
    let state = recorded.fields("warm").resized(expected.size);
    let pairs = state.diffuse.iter().zip(&expected.diffuse);
    assert!(pairs.map(|(a, b)| (a - b).abs()).all(|error| error < 1e-6));
    assert_eq!(state.specular.len(), expected.specular.len());
}
