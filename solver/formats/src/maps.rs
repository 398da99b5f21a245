//! The maps folder: what every solver leaves behind.

use std::io;
use std::path::{Path, PathBuf};

use crate::atomic::{Folder, FolderError};
use crate::picture::{self, Content, GrayImage, Picture, PictureError};

/// A maps folder that cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum MapsError {
    /// The folder must not be written where it was to be.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A file or the folder itself cannot be read or written.
    #[error("{path}: {source}")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The operating system's error.
        source: io::Error,
    },
    /// A picture file is faulty.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A map is not square, or has another size than the others.
    #[error("{path}: {reason}")]
    Size {
        /// The file.
        path: PathBuf,
        /// The fault and its fix.
        reason: String,
    },
}

/// Square reflectance maps of one size; what a solver does not recover is absent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Maps {
    /// RGB, linear Rec.709 reflectance.
    pub diffuse_albedo: Option<Picture>,
    /// One channel: reflectance at normal incidence, 0 to 0.05.
    pub specular_albedo: Option<Picture>,
    /// Unit vectors in object space.
    pub diffuse_normal: Option<Picture>,
    /// Unit vectors in object space.
    pub specular_normal: Option<Picture>,
    /// One channel, 0 to 1: the solver's own trust in the diffuse albedo.
    pub confidence: Option<Picture>,
    /// GGX alphas of the two lobes, and the share of the first. The truth has it, and whoever solves
    /// for it; without it maps are relit with the standard lobes of skin.
    pub roughness: Option<Picture>,
    /// 255 where the map had data.
    pub coverage: Option<GrayImage>,
}

type Field = fn(&mut Maps) -> &mut Option<Picture>;

/// File, channel names, and the place of each float map.
const FILES: [(&str, &[&str], Field); 6] = [
    ("diffuse_albedo.exr", &["R", "G", "B"], |maps| &mut maps.diffuse_albedo),
    ("specular_albedo.exr", &["Y"], |maps| &mut maps.specular_albedo),
    ("diffuse_normal.exr", &["R", "G", "B"], |maps| &mut maps.diffuse_normal),
    ("specular_normal.exr", &["R", "G", "B"], |maps| &mut maps.specular_normal),
    ("confidence.exr", &["Y"], |maps| &mut maps.confidence),
    ("roughness.exr", &["alpha1", "alpha2", "share1"], |maps| &mut maps.roughness),
];
const COVERAGE: &str = "coverage.png";

impl Maps {
    /// Reads whatever maps `folder` has; they must be square and of one size, and finite but for
    /// texels that the coverage leaves out, which become 0 there. The diffuse albedo is a colour:
    /// linear Rec.709 once read, whatever its file states.
    pub fn read(folder: &Path) -> Result<Self, MapsError> {
        if let Err(source) = std::fs::read_dir(folder) {
            return Err(MapsError::Io { path: folder.to_path_buf(), source });
        }
        let mut maps = Self::default();
        let mut side = None;
        let path = folder.join(COVERAGE);
        let coverage = path.exists().then(|| picture::read_png_gray(&path)).transpose()?;
        for (file, channels, field) in FILES {
            let path = folder.join(file);
            if path.exists() {
                let is_colour = file == "diffuse_albedo.exr";
                let content = if is_colour { Content::Colour } else { Content::Data };
                let mut map = picture::read_exr_unchecked(&path, channels, content)?;
                check_side(&path, map.width, map.height, &mut side)?;
                if let Some(coverage) = &coverage {
                    map.blacken_not_finite(|texel| coverage.data.get(texel) == Some(&0));
                }
                map.require_finite(&path, channels)?;
                *field(&mut maps) = Some(map);
            }
        }
        if let Some(coverage) = coverage {
            check_side(&path, coverage.width, coverage.height, &mut side)?;
            maps.coverage = Some(coverage);
        }
        Ok(maps)
    }

    /// Writes a folder with the maps that there are, completely or not at all.
    pub fn write(&self, folder: &Path) -> Result<(), MapsError> {
        let partial = Folder::begin(folder)?;
        self.write_into(partial.path())?;
        Ok(partial.commit()?)
    }

    /// Writes the files into a folder that exists, for callers that add files of their own.
    pub fn write_into(&self, folder: &Path) -> Result<(), MapsError> {
        let mut maps = self.clone();
        for (file, channels, field) in FILES {
            if let Some(map) = field(&mut maps) {
                picture::write_exr(&folder.join(file), map, channels)?;
            }
        }
        if let Some(coverage) = &self.coverage {
            picture::write_png_gray(&folder.join(COVERAGE), coverage)?;
        }
        Ok(())
    }
}

/// Reads `<map>_std.exr` of `folder`, the standard deviation per texel that a method states for a map: these channels, or
/// the first one if it stands for all. Its values may be not finite. `None` without the file.
pub fn read_deviation(
    folder: &Path,
    map: &str,
    channels: &[&str],
) -> Result<Option<Picture>, PictureError> {
    let path = folder.join(format!("{map}_std.exr"));
    if !path.is_file() {
        return Ok(None);
    }
    let names = picture::exr_channel_names(&path)?;
    let has_all = channels.iter().all(|wanted| names.iter().any(|name| name == wanted));
    let first: Vec<&str> = names.iter().take(1).map(String::as_str).collect();
    let wanted = if has_all { channels } else { &first };
    picture::read_exr_unchecked(&path, wanted, Content::Data).map(Some)
}

fn check_side(
    path: &Path,
    width: usize,
    height: usize,
    side: &mut Option<usize>,
) -> Result<(), MapsError> {
    let expected = *side.get_or_insert(width);
    if (width, height) == (expected, expected) {
        return Ok(());
    }
    let reason = format!(
        "is {width}x{height}, expected {expected}x{expected}; maps are square and of one size"
    );
    Err(MapsError::Size { path: path.to_path_buf(), reason })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deviation_of_one_channel_stands_for_all() {
        let root = tempfile::tempdir().unwrap();
        let read = || read_deviation(root.path(), "diffuse_albedo", &["R", "G", "B"]).unwrap();
        assert!(read().is_none());
        let path = root.path().join("diffuse_albedo_std.exr");
        for names in [&["Y"][..], &["R", "G", "B"]] {
            picture::write_exr(&path, &Picture::new(2, 2, names.len()), names).unwrap();
            assert_eq!(read().unwrap().channels, names.len());
        }
    }

    #[test]
    fn absent_maps_stay_absent_and_sizes_must_agree() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("maps");
        let mut albedo = Picture::new(4, 4, 3);
        albedo.pixel_mut(1, 2)[0] = 0.5;
        let maps = Maps { diffuse_albedo: Some(albedo), ..Maps::default() };
        maps.write(&folder).unwrap();
        assert_eq!(Maps::read(&folder).unwrap(), maps);
        picture::write_exr(&folder.join("specular_albedo.exr"), &Picture::new(8, 8, 1), &["Y"])
            .unwrap();
        let error = Maps::read(&folder).unwrap_err().to_string();
        assert!(error.contains("specular_albedo.exr: is 8x8, expected 4x4"), "{error}");
        assert!(Maps::read(&root.path().join("absent")).is_err());
    }

    #[test]
    fn a_roughness_map_keeps_its_channels_apart() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("maps");
        let mut roughness = Picture::new(2, 2, 3);
        roughness.pixel_mut(1, 0).copy_from_slice(&[0.1, 0.4, 0.7]);
        let maps = Maps { roughness: Some(roughness), ..Maps::default() };
        maps.write(&folder).unwrap();
        let file = folder.join("roughness.exr");
        assert_eq!(picture::read_exr(&file, &["share1"]).unwrap().pixel(1, 0), [0.7]);
        assert_eq!(Maps::read(&folder).unwrap(), maps);
    }

    #[test]
    fn texels_that_the_coverage_leaves_out_may_hold_anything() {
        let root = tempfile::tempdir().unwrap();
        let mut coverage = GrayImage::new(4, 4);
        coverage.data.fill(255);
        coverage.data[6] = 0;
        let mut normal = Picture::new(4, 4, 3);
        normal.pixel_mut(2, 1)[1] = f32::NAN;
        let written =
            Maps { diffuse_normal: Some(normal), coverage: Some(coverage), ..Maps::default() };
        written.write(&root.path().join("maps")).unwrap();
        let maps = Maps::read(&root.path().join("maps")).unwrap();
        assert_eq!(maps.diffuse_normal, Some(Picture::new(4, 4, 3)));
        std::fs::remove_file(root.path().join("maps/coverage.png")).unwrap();
        let error = Maps::read(&root.path().join("maps")).unwrap_err().to_string();
        assert!(error.contains("NaN at column 2, row 1, channel G"), "{error}");
    }
}
