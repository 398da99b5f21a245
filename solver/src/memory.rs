//! The memory of a solve, estimated before it begins.
//!
//! All large arrays are over pixels or texels, so the peak follows from their numbers. The constants count 32-bit values
//! at the peak of each phase; a phase frees its memory at the end.
//!
//! - Always: picture, mask and labels of every training view (14 bytes a pixel of the frame); the
//!   G-buffer of what is covered (52 bytes a covered pixel).
//! - Samples: 14 values and 5 words of place, 76 bytes; 190 more while they are sorted. (Those of `unshade` have 10
//!   values; the estimates of `unshade` were measured with 14, and are upper bounds.)
//! - Warm-up and transport work on a quarter of the pixels (if `warm_up.half_resolution`), whose
//!   pictures and G-buffers come on top; transport holds its samples twice, and six copies of its
//!   matrix (texels inside the chart x cells of the sky) while bounces are added; or three, and as many
//!   cells for each of the samples whose highlights are followed.
//! - Heights: 490 bytes a sample during the linearisation (samples, light vector, directions, highlights, slopes,
//!   residuals and unknowns), 100 bytes a texel of the height texture; 100 bytes a sample more if relief is tested on
//!   the views of the other side.
//! - Fine-tuning: 190 bytes a sample (samples, light vector, albedos; the rest is what the allocator
//!   keeps) and 190 bytes a texel (7 values of the state, 8 moments, 8 as samples see them, 8 gradients, 12 of
//!   the blur; the rest again the allocator's).
//! - Maps: 130 bytes a texel of the maps (state, surface, maps, and the copies that are written),
//!   while the samples of the fine-tuning are still there.
//!
//! Estimated and measured peaks (largest resident set of `unshade solve --backend cpu`, ten views; those of
//! `unshade` except the first without the test of relief on views of the other side):
//!
//! | configuration | pixels | textures | estimate | measured |
//! |---|---|---|---|---|
//! | `unshade` | 256 thousand | 512² | 284 MB | 285 MB |
//! | `unshade` | 251 thousand | 1024² | 299 MB | 304 MB |
//! | `unshade` | 251 thousand | 2048² | 833 MB | 824 MB |
//! | `unshade` | 1.0 million | 512² | 645 MB | 648 MB |
//! | `unshade` | 1.0 million | 1024² | 687 MB | 675 MB |
//! | `unshade` | 1.0 million | 2048² | 1043 MB | 1060 MB |
//! | `paper` | 251 thousand | 512² | 154 MB | 156 MB |
//! | `paper` | 251 thousand | 1024² | 257 MB | 265 MB |
//! | `paper` | 251 thousand | 2048² | 666 MB | 637 MB |
//! | `paper` | 1.0 million | 512² | 406 MB | 382 MB |
//! | `paper` | 1.0 million | 1024² | 466 MB | 441 MB |
//! | `paper` | 1.0 million | 2048² | 875 MB | 827 MB |

use std::fmt;
use std::fs;

use capture::Capture;

use crate::config::Config;

/// Program, libraries and the stacks and scratch of the threads.
const PROGRAM: f64 = 50e6;
const FRAME_PIXEL: f64 = 14.0;
const COVERED_PIXEL: f64 = 52.0;
const SAMPLE: f64 = 76.0;
const SORTING: f64 = 190.0;
const WARM_UP_SAMPLE: f64 = 180.0;
const WARM_UP_TEXEL: f64 = 130.0;
const TRANSPORT_SAMPLE: f64 = 280.0;
const HEIGHT_SAMPLE: f64 = 490.0;
const SIDES_SAMPLE: f64 = 100.0;
const HEIGHT_TEXEL: f64 = 100.0;
const FINE_SAMPLE: f64 = 190.0;
const FINE_TEXEL: f64 = 190.0;
const RELIEF_TEXEL: f64 = 28.0;
const ALBEDO_TEXEL: f64 = 130.0;
const MAP_TEXEL: f64 = 130.0;
/// Share of the square that a chart covers.
const CHART: f64 = 0.8;

/// The size of a solve, and its memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Training views.
    pub views: usize,
    /// Pixels inside the masks of these views.
    pub pixels: usize,
    /// Side of the textures, texels.
    pub texture_size: usize,
    /// Bytes at the peak.
    pub peak: u64,
    /// Bytes of the peak that the open capture already uses.
    pub taken: u64,
}

/// Not enough memory.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "the solve needs {} of memory more ({estimate} in all), but {} are free; lower \
     the textures' texture_size, take the pictures at half their size, or fewer views",
    bytes(*needed), bytes(*available)
)]
pub struct NotEnoughMemory {
    /// The size of the solve.
    pub estimate: Estimate,
    /// Bytes in addition to those already used.
    pub needed: u64,
    /// Available bytes.
    pub available: u64,
}

impl Estimate {
    /// The estimate of a solve on the processor.
    pub fn new(capture: &Capture, config: &Config) -> Self {
        let views = &capture.train;
        let frame: usize = views.iter().map(|view| view.mask.data.len()).sum();
        let covered = |data: &[u8]| data.iter().filter(|value| **value == 255).count();
        let pixels = views.iter().map(|view| covered(&view.mask.data)).sum();
        let size = config.texture_size().solved(capture);
        Self::of(views.len(), frame, pixels, size, config)
    }

    /// For `frame` pixels of which `pixels` are covered, and textures of side `size`.
    pub fn of(views: usize, frame: usize, pixels: usize, size: usize, config: &Config) -> Self {
        let texture_size = config.texture_size();
        let (all, covered) = (frame as f64, pixels as f64);
        let taken = PROGRAM + all * FRAME_PIXEL;
        let base = taken + covered * COVERED_PIXEL;
        let half_pictures = 0.25 * (all * FRAME_PIXEL + covered * COVERED_PIXEL);
        let sorting = covered * (SAMPLE + SORTING);
        let maps = square(texture_size.maps(size)) * MAP_TEXEL + covered * SAMPLE;
        let stages = match config {
            Config::Paper(config) => {
                let share = if config.warm_up.half_resolution { 0.25 } else { 1.0 };
                let warm_up = half_pictures
                    + share * covered * WARM_UP_SAMPLE.max(SAMPLE + SORTING)
                    + square(config.warm_up.texture_size) * WARM_UP_TEXEL;
                [warm_up, covered * FINE_SAMPLE + square(size) * FINE_TEXEL, 0.0]
            }
            Config::Unshade(config) => {
                let cast = &config.transport;
                let cells = (2 * cast.rows * cast.rows) as f64;
                let matrix = CHART * square(cast.texture_size) * cells * 4.0;
                let samples = 0.25 * covered;
                let followed = samples.min(config.light.samples as f64) * cells * 4.0;
                let light = half_pictures
                    + samples * TRANSPORT_SAMPLE
                    + (6.0 * matrix).max(3.0 * matrix + 2.0 * followed);
                let side = (size as f64 * f64::from(config.relief.texture_scale)) as usize;
                let sides = if config.relief.minimum_agreement > 0.0 { SIDES_SAMPLE } else { 0.0 };
                let relief = 2.0 * matrix
                    + covered * (HEIGHT_SAMPLE + sides)
                    + square(side) * HEIGHT_TEXEL
                    + square(size) * RELIEF_TEXEL;
                let albedo = 2.0 * matrix + covered * FINE_SAMPLE + square(size) * ALBEDO_TEXEL;
                [light, relief, albedo]
            }
        };
        let most = stages.into_iter().chain([sorting, maps]).fold(0.0, f64::max);
        Self { views, pixels, texture_size: size, peak: (base + most) as u64, taken: taken as u64 }
    }

    /// Refuses a solve that needs more than `available` bytes in addition to those already used.
    pub fn fits(&self, available: Option<u64>) -> Result<(), NotEnoughMemory> {
        let needed = self.peak.saturating_sub(self.taken);
        match available {
            Some(available) if needed > available => {
                Err(NotEnoughMemory { estimate: self.clone(), needed, available })
            }
            _ => Ok(()),
        }
    }
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { views, pixels, texture_size, peak, .. } = self;
        let views = if *views == 1 { "1 view".to_owned() } else { format!("{views} views") };
        let (pixels, memory) = (count(*pixels), bytes(*peak));
        write!(f, "{pixels} pixels of {views}, {texture_size} x {texture_size} textures, {memory}")
    }
}

fn square(side: usize) -> f64 {
    (side * side) as f64
}

fn count(number: usize) -> String {
    match number {
        0..10_000 => number.to_string(),
        10_000..1_000_000 => format!("{} thousand", number / 1000),
        _ => format!("{:.1} million", number as f64 / 1e6),
    }
}

/// Bytes as text, in MB or GB.
pub(crate) fn bytes(bytes: u64) -> String {
    match bytes {
        0..1_000_000_000 => format!("{} MB", bytes.div_ceil(1_000_000)),
        _ => format!("{:.1} GB", bytes as f64 / 1e9),
    }
}

/// Bytes available without swapping, of the machine or of the control group (a container), whichever has less; `None`
/// if the system does not report them.
pub fn available() -> Option<u64> {
    let info = fs::read_to_string("/proc/meminfo").ok()?;
    let line = info.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let machine = line.trim().trim_end_matches(" kB").parse::<u64>().ok()? * 1024;
    let read = |file: &str| {
        fs::read_to_string(format!("/sys/fs/cgroup/{file}")).ok()?.trim().parse::<u64>().ok()
    };
    let group = read("memory.max").zip(read("memory.current"));
    Some(group.map_or(machine, |(most, now)| machine.min(most.saturating_sub(now))))
}

/// The allocator's limits, here and by default: how many pieces of their own it may ask of the system,
/// and from how many free bytes on it gives back. (The size of such a piece has a limit, 32 MiB, which
/// the textures and planes of a large solve exceed.)
const KEEPING: [i32; 2] = [0, i32::MAX];
const USUAL: [i32; 2] = [65_536, 128 * 1024];

/// While it lives, the allocator keeps what is freed for the next allocation. Every step takes and gives
/// back the same tens of megabytes; if they went to the system in between, clearing their pages anew
/// would be half of a step with large textures.
#[derive(Debug)]
pub struct KeepFreedMemory(());

impl KeepFreedMemory {
    /// Starts to keep freed memory.
    pub fn begin() -> Self {
        Self::set(KEEPING);
        Self(())
    }

    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    fn set([pieces, bytes]: [i32; 2]) {
        // SAFETY: both calls only change limits of the allocator, under its own lock.
        unsafe {
            libc::mallopt(libc::M_MMAP_MAX, pieces);
            libc::mallopt(libc::M_TRIM_THRESHOLD, bytes);
        }
    }

    #[cfg(not(all(target_os = "linux", target_env = "gnu")))]
    fn set(_: [i32; 2]) {}
}

impl Drop for KeepFreedMemory {
    fn drop(&mut self) {
        Self::set(USUAL);
        // SAFETY: gives free memory back to the system, under the allocator's own lock.
        #[cfg(all(target_os = "linux", target_env = "gnu"))]
        unsafe {
            libc::malloc_trim(0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn larger_solves_need_more_memory_and_the_refusal_names_fixes() {
        let config = Config::default();
        let of = |frame, pixels, size| Estimate::of(10, frame, pixels, size, &config);
        let small = of(655_360, 250_000, 512).peak;
        assert!(of(10_485_760, 4_000_000, 512).peak > 4 * small);
        let estimate = of(655_360, 250_000, 4096);
        assert!(estimate.peak > 2_000_000_000);
        assert!(estimate.fits(None).is_ok() && estimate.fits(Some(estimate.peak)).is_ok());
        let error = estimate.fits(Some(1 << 30)).unwrap_err().to_string();
        for word in ["texture_size", "views", "half", "1.1 GB", "4096"] {
            assert!(error.contains(word), "{word}: {error}");
        }
        assert!(!error.contains('\n'));
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn available_memory_is_reported() {
        assert!(available().unwrap() > 1 << 20);
    }
}
