//! EXR files: channels of any part, placed in the display window.

use std::collections::{BTreeMap, HashSet};
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use exr::block::reader::ChunksReader;
use exr::block::{UncompressedBlock, chunk::Chunk};
use exr::meta::MetaData;
use exr::meta::attribute::{EnvironmentMap, SampleType};
use exr::meta::header::Header;
use exr::prelude::f16;
use rayon::prelude::*;

use super::colour::{self, Chromaticities};
use super::exr_channels::{self, NoPlace, Place};
use super::{Picture, PictureError, exr_dwa, kind, limits};
use crate::cancel;

/// A layer whose R, G, B are no colour, but the variances of one.
const VARIANCE: &str = "variance.";
/// Blocks that are decompressed at a time, so that few are in memory.
const BATCH: usize = 64;

/// Meaning of a picture's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// Radiance or albedo: linear Rec.709 once read, whatever primaries the file states.
    Colour,
    /// Normals, roughness, masks and the like: as they are in the file.
    Data,
}

/// An EXR file whose header was read; pixels are read when asked for.
pub struct ExrFile {
    path: PathBuf,
    bytes: Vec<u8>,
    meta: MetaData,
}

impl ExrFile {
    /// Reads the header of a file.
    pub fn open(path: &Path) -> Result<Self, PictureError> {
        Self::from_bytes(path, kind::bytes_of(path)?)
    }

    /// Reads the header of a file in memory; `path` is for messages.
    pub fn from_bytes(path: &Path, bytes: Vec<u8>) -> Result<Self, PictureError> {
        cancel::check();
        if !kind::is_exr(&bytes) {
            return Err(match kind::why_not(&bytes) {
                Some(reason) => PictureError::Refused { path: path.to_path_buf(), reason },
                None => read_error(path, "no EXR file; save it as float EXR"),
            });
        }
        let meta = guarded(|| {
            MetaData::read_from_buffered(Cursor::new(&bytes[..]), false).map_err(explained)
        });
        let meta = meta.map_err(|reason| read_error(path, reason))?;
        Ok(Self { path: path.to_path_buf(), bytes, meta })
    }

    /// The names by which channels can be asked for: as in the file, with the part's name before
    /// it where that is needed; R, G, B too where one layer is the file's colour.
    pub fn channel_names(&self) -> Vec<String> {
        exr_channels::names(&self.meta.headers)
    }

    /// Returns whether the header says that the picture is the six sides of a cube.
    pub fn is_cube_map(&self) -> bool {
        let cube = Some(EnvironmentMap::Cube);
        self.meta.headers.iter().any(|header| header.own_attributes.environment_map == cube)
    }

    /// The channels `names` as 32-bit floats in the display window, black where there is no data;
    /// NaN and infinities stay. Of colours, R, G, B and each layer's are converted to linear Rec.709.
    pub fn read(&self, names: &[&str], content: Content) -> Result<Picture, PictureError> {
        let places = exr_channels::locate(&self.meta.headers, names).map_err(|reason| {
            let path = self.path.clone();
            match reason {
                NoPlace::Missing { channel, present } => {
                    PictureError::MissingChannel { path, channel, present }
                }
                NoPlace::Several(reason) => PictureError::Refused { path, reason },
            }
        })?;
        let mut picture =
            guarded(|| self.planes(&places)).map_err(|reason| read_error(&self.path, reason))?;
        if content == Content::Colour {
            self.to_rec709(&mut picture, names, &places)
                .map_err(|reason| PictureError::Refused { path: self.path.clone(), reason })?;
        }
        Ok(picture)
    }

    fn planes(&self, places: &[Place]) -> Result<Picture, String> {
        let Some(first) = self.meta.headers.first() else { return Err("is empty".to_owned()) };
        let size = first.shared_attributes.display_window.size;
        limits::check(size.0 as u64, size.1 as u64, places.len() as u64, self.bytes.len())?;
        let mut slots: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
        for (slot, (part, channel)) in places.iter().enumerate() {
            slots.entry(*part).or_default().push((*channel, slot));
        }
        for part in slots.keys() {
            let header = &self.meta.headers[*part];
            let (width, height) = (header.layer_size.0 as u64, header.layer_size.1 as u64);
            let channels = header.channels.list.len() as u64;
            limits::check(width, height, channels, self.bytes.len())?;
        }
        let mut picture = Picture::new(size.0, size.1, places.len());
        for (part, slots) in slots {
            self.read_part(part, &slots, &mut picture)?;
        }
        Ok(picture)
    }

    fn read_part(
        &self,
        part: usize,
        slots: &[(usize, usize)],
        picture: &mut Picture,
    ) -> Result<(), String> {
        let header = &self.meta.headers[part];
        let reader = exr::block::read(Cursor::new(&self.bytes[..]), false).map_err(explained)?;
        let mut chunks = reader
            .filter_chunks(false, |_, _, block| {
                block.layer == part && (block.level.0, block.level.1) == (0, 0)
            })
            .map_err(explained)?;
        let expected = chunks.expected_chunk_count();
        let mut seen = HashSet::new();
        loop {
            let batch: Vec<Chunk> =
                chunks.by_ref().take(BATCH).collect::<Result<_, _>>().map_err(explained)?;
            if batch.is_empty() {
                break;
            }
            batch.iter().try_for_each(|chunk| exr_dwa::check(header, chunk))?;
            let blocks: Vec<UncompressedBlock> = batch
                .into_par_iter()
                .map(|chunk| UncompressedBlock::decompress_chunk(chunk, &self.meta, false))
                .collect::<Result<_, _>>()
                .map_err(explained)?;
            for block in blocks {
                let (at, level) = (block.index.pixel_position, block.index.level);
                if block.index.layer != part || (level.0, level.1) != (0, 0) {
                    return Err("a block belongs to another part; save it again".to_owned());
                }
                seen.insert((at.0, at.1));
                place(header, &block, slots, picture)?;
            }
        }
        if seen.len() == expected {
            Ok(())
        } else {
            Err("blocks are missing; save it again".to_owned())
        }
    }

    fn to_rec709(
        &self,
        picture: &mut Picture,
        names: &[&str],
        places: &[Place],
    ) -> Result<(), String> {
        let slot = |layer: &str, colour| {
            names.iter().position(|name| name.strip_suffix(colour) == Some(layer))
        };
        for (red, name) in names.iter().enumerate() {
            let Some(layer) = name.strip_suffix('R').filter(|layer| is_colour(layer)) else {
                continue;
            };
            let (Some(green), Some(blue)) = (slot(layer, 'G'), slot(layer, 'B')) else { continue };
            let Some(header) = self.meta.headers.get(places[red].0) else { continue };
            if let Some(stated) = &header.shared_attributes.chromaticities {
                let stated: Chromaticities =
                    [stated.red, stated.green, stated.blue, stated.white].map(|xy| [xy.0, xy.1]);
                if let Some(matrix) = colour::to_rec709(&stated)? {
                    colour::convert(picture, [red, green, blue], &matrix);
                }
            }
        }
        Ok(())
    }
}

/// Copies a block's channels to where the display window has them; what is outside is cut.
fn place(
    header: &Header,
    block: &UncompressedBlock,
    slots: &[(usize, usize)],
    picture: &mut Picture,
) -> Result<(), String> {
    let (corner, window) =
        (header.own_attributes.layer_position, header.shared_attributes.display_window);
    let left = i64::from(corner.0) - i64::from(window.position.0);
    let top = i64::from(corner.1) - i64::from(window.position.1);
    let channels = picture.channels;
    for line in block.lines(&header.channels) {
        let y = top + line.location.position.1 as i64;
        let x = left + line.location.position.0 as i64;
        if y < 0 || y >= picture.height as i64 {
            continue;
        }
        let skipped = usize::try_from(-x.min(0)).map_err(|error| error.to_string())?;
        let from = x.max(0) as usize;
        let count = line.location.sample_count.saturating_sub(skipped);
        let count = count.min(picture.width.saturating_sub(from));
        if count == 0 {
            continue;
        }
        let row = (y as usize * picture.width + from) * channels;
        let Some(channel) = header.channels.list.get(line.location.channel) else { continue };
        for (_, slot) in slots.iter().filter(|(channel, _)| *channel == line.location.channel) {
            let targets = picture.data[row..].iter_mut().skip(*slot).step_by(channels).take(count);
            let samples = &line.value[skipped * channel.sample_type.bytes_per_sample()..];
            match channel.sample_type {
                SampleType::F32 => fill(targets, samples, f32::from_ne_bytes),
                SampleType::F16 => fill(targets, samples, |b| f16::from_ne_bytes(b).to_f32()),
                SampleType::U32 => fill(targets, samples, |b| u32::from_ne_bytes(b) as f32),
            }
        }
    }
    Ok(())
}

fn fill<'a, const N: usize>(
    targets: impl Iterator<Item = &'a mut f32>,
    samples: &[u8],
    value: impl Fn([u8; N]) -> f32,
) {
    for (target, sample) in targets.zip(samples.as_chunks::<N>().0) {
        *target = value(*sample);
    }
}

/// Returns whether `layer.R` is a colour: the picture's own, or a layer's.
fn is_colour(layer: &str) -> bool {
    layer.is_empty() || layer.ends_with('.') && layer != VARIANCE
}

/// The decoder's error, with the fix where a kind of file is not read.
fn explained(error: exr::error::Error) -> String {
    let said = error.to_string().replace(char::is_control, " ");
    let fix = if said.contains("deep data") {
        "; flatten the deep picture and save it as float EXR"
    } else if said.contains("subsampling") {
        "; save it with R, G, B instead of luminance and chroma"
    } else if said.contains("compression") {
        "; save it with ZIP compression"
    } else {
        ""
    };
    format!("{said}{fix}")
}

/// The decoder's panics as errors: what a damaged file meets must not end the program.
fn guarded<T>(read: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(read))
        .unwrap_or_else(|_| Err("is damaged; save it again".to_owned()))
}

fn read_error(path: &Path, reason: impl ToString) -> PictureError {
    PictureError::Read { path: path.to_path_buf(), reason: reason.to_string() }
}
