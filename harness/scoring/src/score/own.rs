//! Pictures that a method relit itself, in the place of those that its maps are relit to.

use std::fs;
use std::path::Path;

use formats::atomic::{self, Folder};
use formats::picture::{Given, Picture, write_exr_rgb};

use super::error::ScoreError;
use super::photographs::is_photographed;
use super::pictures::Frame;
use super::protocol::OWN;
use super::truth::{self, AGAIN, Identity, present};

const INCOMPLETE: &str = "either all withheld frames of a light are given or none";

/// Writes the folder `out` of relit pictures of what `maps` has in `relit/<light>`: as they are, and for
/// the scale `global` after one factor for all lights and frames, since there is no albedo to scale.
/// Nothing is taken with a capture without a truth, which cannot judge them.
pub fn keep_own_relit(
    capture: &Path,
    maps: &Path,
    out: &Path,
    scales: &[&str],
) -> Result<(), ScoreError> {
    atomic::refuse_overlap(out, &[capture, maps])?;
    let folder = Folder::begin(out)?;
    let io = |error| ScoreError::io(out, error);
    let mut factor = 1.0;
    if !is_photographed(capture) {
        let given = given(capture, &maps.join("relit"))?;
        factor = one_factor(&given);
        for (scale, times) in [("none", 1.0), ("global", factor)] {
            if !scales.contains(&scale) {
                continue;
            }
            for Relit { light, frame, picture, .. } in &given {
                let path = folder.path().join(scale).join(light);
                fs::create_dir_all(&path).map_err(io)?;
                let data = picture.data.iter().map(|value| value * times as f32).collect();
                let scaled = Picture { data, ..*picture };
                write_exr_rgb(&path.join(format!("{frame}.exr")), &scaled)?;
            }
        }
    }
    let said = serde_json::json!({"renderer": OWN, "scales": {"none": 1.0, "global": factor}});
    fs::write(folder.path().join("relit.json"), format!("{said}\n")).map_err(io)?;
    Ok(folder.commit()?)
}

/// A picture, the true one, and which they are.
struct Relit {
    light: String,
    frame: String,
    picture: Picture,
    truth: Picture,
    pixels: Vec<usize>,
}

fn given(capture: &Path, relit: &Path) -> Result<Vec<Relit>, ScoreError> {
    let own = Identity::read(capture)?.light;
    let frames = Frame::withheld(capture, &own)?;
    let lights = truth::lights(capture)?;
    let strange = |name: &String| relit.join(name).is_dir() && !lights.contains(name);
    if let Some(name) = truth::names(relit)?.iter().find(|name| strange(name)) {
        return Err(ScoreError::Light { path: relit.join(name), known: lights.join(", ") });
    }
    let mut all = Vec::new();
    for light in lights.iter().filter(|light| relit.join(light).is_dir()) {
        let truths = truth::folder(capture)?.join("relit").join(light);
        for frame in &frames {
            let name = frame.name();
            let folder = relit.join(light);
            let found = Given::Colour.read(&folder, name)?;
            let picture = found.ok_or_else(|| ScoreError::Missing {
                path: folder.join(format!("{name}.exr")),
                fix: INCOMPLETE,
            })?;
            let path = present(truths.join(format!("{name}.exr")), AGAIN)?;
            let truth = formats::picture::read_exr_colour(&path, &["R", "G", "B"])?;
            truth::check_size(&folder.join(name), truth::size(&picture), truth::size(&truth))?;
            let (light, frame, pixels) = (light.clone(), name.to_owned(), frame.pixels().to_vec());
            all.push(Relit { light, frame, picture, truth, pixels });
        }
    }
    Ok(all)
}

/// k = <p, g> / <p, p> over the eroded masks of all pictures; 1 for black ones.
fn one_factor(given: &[Relit]) -> f64 {
    let (mut across, mut square) = (0.0, 0.0);
    for Relit { picture, truth, pixels, .. } in given {
        for value in pixels.iter().flat_map(|pixel| 3 * pixel..3 * pixel + 3) {
            let (p, g) = (f64::from(picture.data[value]), f64::from(truth.data[value]));
            across += p * g;
            square += p * p;
        }
    }
    if square > 0.0 && across > 0.0 { across / square } else { 1.0 }
}
