//! Requests to the renderer's process: one for each function of `synth/unshade/stage.py`, with its arguments.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use scoring::score::Shown;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A stage that Python does.
#[derive(Serialize)]
#[serde(tag = "stage", rename_all = "snake_case")]
#[allow(missing_docs)]
pub enum Request<'a> {
    /// Renders a resolved scene file into a capture.
    Synth { scene: &'a Path, out: &'a Path },
    /// Reads resolved scene files and renders nothing.
    Check { scenes: &'a [PathBuf] },
    /// Describes a resolved scene file in words.
    Describe { scene: &'a Path },
    /// Renders sampled identities into one picture.
    ContactSheet { count: u32, seed: u64, out: &'a Path },
    /// Renders maps in a capture's lights, or in the lat-long picture `light`; `scales` are factors on the albedo.
    Relight {
        capture: &'a Path,
        maps: &'a Path,
        out: &'a Path,
        renderer: &'a str,
        scales: &'a [(&'a str, f64)],
        light: Option<&'a Path>,
    },
    /// Attributes a relit view's error to each map; `factor` is that of the albedo.
    Budget {
        capture: &'a Path,
        maps: &'a Path,
        out: &'a Path,
        light: Option<&'a str>,
        view: Option<&'a str>,
        factor: f64,
    },
    /// Writes the lights of a capture, without its own, as lat-long pictures.
    Lights { capture: &'a Path, out: &'a Path },
    /// Writes maps as an asset of another program.
    Export(&'a Export),
    /// Judges pictures by the network `net`.
    Lpips { net: &'a str, pictures: &'a [Shown] },
    /// Calls a user's metrics.
    Metrics { names: &'a [String], folder: &'a Path, pairs: &'a [Shown] },
    /// Draws the figure that was gathered in a folder.
    Figure { folder: &'a Path },
    /// Recovers maps by a method of the package; `settings` are its keyword arguments.
    Method { name: &'a str, capture: &'a Path, out: &'a Path, settings: Value },
    /// Does the stages of a suite on a cluster of Dask.
    Cluster { order: &'a Value, address: &'a str, store: &'a str, workers: usize },
    /// Draws the history of a suite's scores.
    History { history: &'a Path, out: &'a Path },
    /// Examines what rendering finds on this machine.
    Doctor,
    /// Checks the renderer against physics.
    Physics,
}

/// An asset to be written.
#[derive(Args, Serialize, Deserialize)]
pub struct Export {
    /// The maps' folder.
    pub maps: PathBuf,
    /// The asset's format.
    #[arg(long, value_enum)]
    format: Format,
    /// The asset's folder.
    #[arg(short, long)]
    pub out: PathBuf,
    /// The capture that the maps belong to: its mesh, and the light and the withheld views in which the
    /// asset is compared.
    #[arg(long, required_unless_present = "mesh")]
    pub capture: Option<PathBuf>,
    /// An OBJ with UV. Without a capture: the maps' own mesh; the asset is compared in uniform light. With one: the
    /// same face with other UV, such as the mesh that was imported; the maps are resampled onto it.
    #[arg(long)]
    pub mesh: Option<PathBuf>,
    /// Bits of the PNGs that hold normals, and of all maps of `png`.
    #[arg(long, default_value = "16", value_parser = bits)]
    bits: u8,
    /// Which way green points in the normal maps of `png`: plus as in glTF, minus as in MetaHuman.
    #[arg(long, value_enum, default_value_t = Green::Plus)]
    normal_y: Green,
    /// Write the asset without comparing it.
    #[arg(long)]
    no_fidelity: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Format {
    /// glTF 2.0, one GLB.
    Gltf,
    /// A complete scene.
    Mitsuba,
    /// A .blend (`make cycles`).
    Blender,
    /// An OpenPBR surface with its textures.
    Materialx,
    /// Textures only.
    Png,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Green {
    /// Green points up.
    Plus,
    /// Green points down.
    Minus,
}

fn bits(text: &str) -> Result<u8, String> {
    let bits = text.parse().ok().filter(|bits| [8, 16].contains(bits));
    bits.ok_or_else(|| "must be 8 or 16".to_owned())
}
