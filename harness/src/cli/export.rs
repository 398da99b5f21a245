//! `unshade export`.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::alone::alone;
use crate::suite::{self, RunError};

#[derive(Args)]
pub(super) struct ExportArgs {
    /// The maps' folder.
    maps: PathBuf,
    /// The asset's format.
    #[arg(long, value_enum)]
    format: FormatName,
    /// The asset's folder.
    #[arg(short, long)]
    out: PathBuf,
    /// The capture that the maps belong to: its mesh, and the light and the withheld views in which the
    /// asset is compared.
    #[arg(long, required_unless_present = "mesh")]
    capture: Option<PathBuf>,
    /// The mesh of maps without a capture: an OBJ with UV; the asset is then compared in uniform light.
    #[arg(long, conflicts_with = "capture")]
    mesh: Option<PathBuf>,
    /// Bits of the PNGs that hold normals, and of all maps of `png`.
    #[arg(long, default_value = "16", value_parser = ["8", "16"])]
    bits: String,
    /// Which way green points in the normal maps of `png`: plus as in glTF, minus as in MetaHuman.
    #[arg(long, value_enum, default_value_t = GreenName::Plus)]
    normal_y: GreenName,
    /// Write the asset without comparing it.
    #[arg(long)]
    no_fidelity: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum FormatName {
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

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum GreenName {
    /// Green points up.
    Plus,
    /// Green points down.
    Minus,
}

/// Writes the asset and says what it loses.
pub(super) fn export(arguments: &ExportArgs) -> Result<(), RunError> {
    let format = match arguments.format {
        FormatName::Gltf => "gltf",
        FormatName::Mitsuba => "mitsuba",
        FormatName::Blender => "blender",
        FormatName::Materialx => "materialx",
        FormatName::Png => "png",
    };
    let green = if arguments.normal_y == GreenName::Plus { "plus" } else { "minus" };
    let mut options: Vec<OsString> =
        ["--format", format, "--bits", &arguments.bits, "--normal-y", green].map(Into::into).into();
    if arguments.no_fidelity {
        options.push("--no-fidelity".into());
    }
    let export = suite::Export {
        maps: &arguments.maps,
        out: &arguments.out,
        capture: arguments.capture.as_deref(),
        mesh: arguments.mesh.as_deref(),
        options,
    };
    alone("export", |tools, step| {
        let said = suite::export(&export, tools, step)?;
        for line in said["lines"].as_array().into_iter().flatten() {
            say!("{}", line.as_str().unwrap_or_default());
        }
        Ok(())
    })
}
