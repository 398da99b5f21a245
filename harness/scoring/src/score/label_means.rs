//! The flat map that has the true mean colour of every label: what an albedo scores without any detail.
//! It reads the truth, so no method has to beat it fairly; what does not exceed it shows no detail.

use std::path::Path;

use capture::Capture;
use capture::gbuffer::Atlas;
use capture::mean_texture::with_mesh_normals;
use formats::atomic::{self, Folder};
use formats::fill;
use formats::picture::Picture;

use super::ScoreError;
use super::truth::Truth;

/// Writes a maps folder: at every texel the mean true diffuse albedo (linear) of the covered texels with
/// its label, and the normals of the mesh. Texels without a label take the nearest colour.
pub fn label_mean_maps(capture: &Path, out: &Path) -> Result<(), ScoreError> {
    let truth = Truth::open(capture)?;
    atomic::refuse_overlap(out, &[capture])?;
    let covered: Vec<bool> = truth.coverage.data.iter().map(|value| *value > 0).collect();
    let labels = &truth.labels.data;
    let mut sums = [([0.0_f64; 3], 0.0_f64); 256];
    let colours = truth.diffuse_albedo.data.chunks_exact(3);
    for ((colour, label), _) in colours.zip(labels).zip(&covered).filter(|(_, covered)| **covered) {
        let (sum, count) = &mut sums[usize::from(*label)];
        sum.iter_mut().zip(colour).for_each(|(sum, value)| *sum += f64::from(*value));
        *count += 1.0;
    }
    let known: Vec<bool> =
        labels.iter().map(|label| *label != 0 && sums[usize::from(*label)].1 > 0.0).collect();
    let mean = |label: &u8| {
        let (sum, count) = sums[usize::from(*label)];
        sum.map(|value| (value / f64::max(count, 1.0)) as f32)
    };
    let (width, height) = truth.region.size();
    let data = labels.iter().flat_map(mean).collect();
    let mut albedo = Picture { width, height, channels: 3, data };
    fill::fill_from_nearest(&mut albedo, &known);
    let capture = Capture::reopen(capture)?;
    let maps = with_mesh_normals(&capture, &Atlas::new(&capture.mesh, width), albedo, &covered)?;
    let folder = Folder::begin(out)?;
    maps.write_into(folder.path())?;
    std::fs::write(folder.path().join("solve.json"), "{\n  \"solver\": \"label-means\"\n}\n")
        .map_err(|error| ScoreError::io(out, error))?;
    Ok(folder.commit()?)
}
