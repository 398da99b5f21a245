//! Small pictures of all the kinds that the readers know.

use std::io::Cursor;

use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, ImageAttributes,
    IntegerBounds, Layer, LayerAttributes, LineOrder, SmallVec, Vec2, WritableImage, f16,
};

const WIDTH: usize = 8;
const HEIGHT: usize = 4;

/// EXR files: every compression that can be written, lines and tiles, sample types, layers, parts,
/// windows.
pub fn exr() -> Vec<Vec<u8>> {
    use Compression::{B44, B44A, DWAA, DWAB, PIZ, PXR24, RLE, Uncompressed, ZIP1, ZIP16};
    let ways = [Uncompressed, RLE, ZIP1, ZIP16, PIZ, PXR24, B44, B44A, DWAA(None), DWAB(None)];
    let mut files = Vec::new();
    for compression in ways {
        for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(4, 3))] {
            files.extend(exr_file(&[("", &["R", "G", "B"])], compression, blocks, 0));
        }
    }
    let lines = Blocks::ScanLines;
    files.extend(exr_file(&[("", &["A", "B", "G", "R", "Z"])], Uncompressed, lines, 3));
    files.extend(exr_file(&[("", &["diffuse.R", "diffuse.G", "diffuse.B"])], ZIP16, lines, -2));
    files.extend(exr_file(&[("a", &["R", "G", "B"]), ("b", &["Y"])], RLE, lines, 1));
    assert!(files.len() > 12, "{} EXR files could be written", files.len());
    files
}

fn exr_file(
    parts: &[(&str, &[&str])],
    compression: Compression,
    blocks: Blocks,
    offset: i32,
) -> Option<Vec<u8>> {
    let mut layers = SmallVec::<[Layer<AnyChannels<FlatSamples>>; 2]>::new();
    for (name, channels) in parts {
        let channel = |(slot, channel): (usize, &&str)| {
            let values = (0..WIDTH * HEIGHT).map(|index| (slot + index) as f32 * 0.25 - 1.0);
            let samples = match slot {
                0 => FlatSamples::F16(values.map(f16::from_f32).collect()),
                4 => FlatSamples::U32(values.map(|value| value as u32).collect()),
                _ => FlatSamples::F32(values.collect()),
            };
            AnyChannel::new(*channel, samples)
        };
        let list: SmallVec<[AnyChannel<FlatSamples>; 4]> =
            channels.iter().enumerate().map(channel).collect();
        let own = LayerAttributes {
            layer_name: (!name.is_empty()).then(|| (*name).into()),
            layer_position: Vec2(offset, offset),
            ..LayerAttributes::default()
        };
        let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
        layers.push(Layer::new((WIDTH, HEIGHT), own, encoding, AnyChannels::sort(list)));
    }
    let window = IntegerBounds::new((0, 0), (WIDTH, HEIGHT));
    let mut attributes = ImageAttributes::new(window);
    attributes.chromaticities = Some(exr::meta::attribute::Chromaticities {
        red: Vec2(0.708, 0.292),
        green: Vec2(0.17, 0.797),
        blue: Vec2(0.131, 0.046),
        white: Vec2(0.3127, 0.329),
    });
    let mut bytes = Cursor::new(Vec::new());
    let image = Image { attributes, layer_data: layers };
    let written = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        image.write().non_parallel().to_buffered(&mut bytes)
    }));
    // Not every compression can be written.
    matches!(written, Ok(Ok(()))).then(|| bytes.into_inner())
}

/// PNG files: every colour type and depth, with and without interlacing and compression.
pub fn png() -> Vec<Vec<u8>> {
    use png::{BitDepth, ColorType, Compression, Filter};
    let kinds = [
        (ColorType::Grayscale, BitDepth::One),
        (ColorType::Grayscale, BitDepth::Two),
        (ColorType::Grayscale, BitDepth::Four),
        (ColorType::Grayscale, BitDepth::Eight),
        (ColorType::Grayscale, BitDepth::Sixteen),
        (ColorType::GrayscaleAlpha, BitDepth::Eight),
        (ColorType::Rgb, BitDepth::Eight),
        (ColorType::Rgb, BitDepth::Sixteen),
        (ColorType::Rgba, BitDepth::Sixteen),
        (ColorType::Indexed, BitDepth::Two),
        (ColorType::Indexed, BitDepth::Eight),
    ];
    let mut files = Vec::new();
    for (colour, bits) in kinds {
        for compression in [Compression::NoCompression, Compression::Balanced] {
            let mut bytes = Vec::new();
            let mut encoder = png::Encoder::new(&mut bytes, WIDTH as u32, HEIGHT as u32);
            encoder.set_color(colour);
            encoder.set_depth(bits);
            encoder.set_compression(compression);
            encoder.set_filter(Filter::Paeth);
            if colour == ColorType::Indexed {
                encoder.set_palette((0..12).collect::<Vec<u8>>());
            }
            let row = (WIDTH * colour.samples() * bits as usize).div_ceil(8);
            let data: Vec<u8> = (0..row * HEIGHT).map(|index| (index * 7 % 4) as u8).collect();
            let written = encoder.write_header().and_then(|mut w| w.write_image_data(&data));
            written.unwrap();
            // The same samples in seven passes are others, but as many bytes where rows are whole.
            let mut interlaced = bytes.clone();
            interlaced[28] = 1;
            crate::mutate::repair_png(&mut interlaced);
            files.extend([bytes, interlaced]);
        }
    }
    files
}

/// Radiance files: flat, old and new run lengths, orientations, all lines of a header.
pub fn radiance() -> Vec<Vec<u8>> {
    let head = |lines: &str, size: &str| format!("#?RADIANCE\n{lines}\n{size}\n").into_bytes();
    let rgbe = "FORMAT=32-bit_rle_rgbe\n";
    let flat: Vec<u8> = (0..WIDTH * HEIGHT * 4).map(|index| 120 + (index % 13) as u8).collect();
    let mut new = Vec::new();
    for _ in 0..HEIGHT {
        new.extend_from_slice(&[2, 2, 0, WIDTH as u8]);
        for channel in 0..4 {
            new.extend_from_slice(&[128 + 5, 120 + channel, 3, 7, 8, 9]);
        }
    }
    let mut old = Vec::new();
    for _ in 0..HEIGHT {
        old.extend_from_slice(&[120, 100, 90, 129, 1, 1, 1, 7]);
    }
    let files = [
        (head(rgbe, "-Y 4 +X 8"), &flat),
        (head(rgbe, "-Y 4 +X 8"), &new),
        (head(rgbe, "-Y 4 +X 8"), &old),
        (head(rgbe, "+X 4 -Y 8"), &new),
        (head(rgbe, "+Y 4 -X 8"), &flat),
        (head("FORMAT=32-bit_rle_xyze\n", "-Y 4 +X 8"), &new),
        (
            head(
                "EXPOSURE=2\nCOLORCORR=1 2 .5\nPRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .329\n# a\n",
                "-Y 4 +X 8",
            ),
            &new,
        ),
    ];
    files.into_iter().map(|(head, pixels)| [head.as_slice(), pixels].concat()).collect()
}
