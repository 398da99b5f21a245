//! Sizes that a DWA block states, checked before the decoder takes memory for them.

use exr::block::chunk::{Chunk, CompressedBlock};
use exr::meta::BlockDescription;
use exr::meta::header::Header;
use exr::prelude::Compression;

/// The largest block of scan lines (DWAB).
const LINES: usize = 256;
/// Counters of a block's leader that say how much comes out of its sections: channels as they
/// are, run lengths packed and unpacked, AC and DC coefficients.
const SIZES: [usize; 5] = [1, 6, 7, 8, 9];
/// Largest size of a section over that of its block; run lengths may double a section.
const FACTOR: u64 = 4;
const FREE_BYTES: u64 = 4096;

/// Refuses a block that says it holds more than its pixels.
pub(super) fn check(header: &Header, chunk: &Chunk) -> Result<(), String> {
    if !matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_)) {
        return Ok(());
    }
    let data = match &chunk.compressed_block {
        CompressedBlock::ScanLine(block) => &block.compressed_pixels_le,
        CompressedBlock::Tile(block) => &block.compressed_pixels_le,
        _ => return Ok(()),
    };
    let (width, height) = match header.blocks {
        BlockDescription::ScanLines => (header.layer_size.0, LINES.min(header.layer_size.1)),
        BlockDescription::Tiles(tiles) => {
            (tiles.tile_size.0.min(header.layer_size.0), tiles.tile_size.1.min(header.layer_size.1))
        }
    };
    // Coefficients are of whole 8 x 8 blocks, four bytes a sample at most.
    let side = |pixels: usize| pixels.next_multiple_of(8) as u64;
    let bytes = side(width) * side(height) * header.channels.list.len() as u64 * 4;
    let counters = data.as_chunks::<8>().0;
    let said = SIZES.iter().filter_map(|slot| counters.get(*slot));
    match said.map(|counter| u64::from_le_bytes(*counter)).max() {
        Some(largest) if largest > FACTOR * bytes + FREE_BYTES => {
            Err("a DWA block says it holds more than its pixels; save it again".to_owned())
        }
        _ => Ok(()),
    }
}
