//! The readers, on files that are written here.

use std::path::{Path, PathBuf};

use exr::meta::attribute::{Chromaticities, EnvironmentMap, IntegerBounds};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, Layer, LayerAttributes,
    SmallVec, Vec2, WritableImage,
};

use super::*;

fn gradient() -> Picture {
    let mut picture = Picture::new(5, 3, 3);
    for (index, value) in picture.data.iter_mut().enumerate() {
        *value = index as f32 * 0.25 - 1.0;
    }
    picture
}

/// A part: its name, where its data window begins, and its size; every value is `10 y + x` of the
/// display window, plus 100 a channel.
struct Part(&'static str, [i32; 2], [usize; 2], &'static [&'static str]);

fn attributes(chromaticities: Option<[[f32; 2]; 4]>) -> ImageAttributes {
    let mut attributes = ImageAttributes::new(IntegerBounds::new((0, 0), (8, 4)));
    attributes.chromaticities = chromaticities.map(|space| {
        let [red, green, blue, white] = space.map(|[x, y]| Vec2(x, y));
        Chromaticities { red, green, blue, white }
    });
    attributes
}

fn layer(part: &Part, own: LayerAttributes) -> Layer<AnyChannels<FlatSamples>> {
    let Part(name, [left, top], [width, height], channels) = part;
    let list: SmallVec<[AnyChannel<FlatSamples>; 4]> = channels
        .iter()
        .enumerate()
        .map(|(slot, channel)| {
            let value = |index: usize| {
                let (x, y) = (*left + (index % width) as i32, *top + (index / width) as i32);
                (100 * slot as i32 + 10 * y + x) as f32
            };
            AnyChannel::new(*channel, FlatSamples::F32((0..width * height).map(value).collect()))
        })
        .collect();
    let own = LayerAttributes { layer_position: Vec2(*left, *top), ..own };
    let own = LayerAttributes { layer_name: Some((*name).into()), ..own };
    Layer::new((*width, *height), own, Encoding::default(), AnyChannels::sort(list))
}

/// Writes parts whose display window is 8 x 4.
fn write(parts: &[Part], space: Option<[[f32; 2]; 4]>, own: LayerAttributes) -> (Kept, PathBuf) {
    let kept = tempfile::tempdir().unwrap();
    let path = kept.path().join("picture.exr");
    let layers: SmallVec<[_; 2]> = parts.iter().map(|part| layer(part, own.clone())).collect();
    let image = Image { attributes: attributes(space), layer_data: layers };
    image.write().to_file(&path).unwrap();
    (kept, path)
}

type Kept = tempfile::TempDir;

fn plain(parts: &[Part]) -> (Kept, PathBuf) {
    write(parts, None, LayerAttributes::default())
}

fn full() -> Picture {
    let (_kept, path) = plain(&[Part("", [0, 0], [8, 4], &["R", "G", "B"])]);
    read_exr_rgb(&path).unwrap()
}

const COLOURS: &[&str] = &["R", "G", "B"];

#[test]
fn channels_come_back_by_name_whatever_the_order_in_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("layers.exr");
    write_exr(&path, &gradient(), &["specular.R", "diffuse.R", "B"]).unwrap();
    let back = read_exr(&path, &["specular.R", "diffuse.R", "B"]).unwrap();
    assert_eq!(back, gradient());
    let error = read_exr(&path, &["G"]).unwrap_err().to_string();
    assert!(error.contains("\"G\"") && error.contains("diffuse.R"), "{error}");
}

#[test]
fn halves_come_back_within_their_precision_and_stay_finite() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("half.exr");
    let mut picture = gradient();
    picture.data[0] = 1e9;
    picture.data[1] = 0.1;
    write_exr_half(&path, &picture, COLOURS).unwrap();
    let back = read_exr_rgb(&path).unwrap();
    assert_eq!(back.data[0], 65504.0);
    for (value, half) in picture.data[1..].iter().zip(&back.data[1..]) {
        assert!((value - half).abs() <= 1e-3 * value.abs(), "{value} {half}");
    }
}

#[test]
fn the_same_picture_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (folder.path().join("a.exr"), folder.path().join("b.exr"));
    write_exr_rgb(&a, &gradient()).unwrap();
    write_exr_rgb(&b, &gradient()).unwrap();
    assert_eq!(std::fs::read(a).unwrap(), std::fs::read(b).unwrap());
}

#[test]
fn a_nan_is_reported_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("nan.exr");
    let mut picture = gradient();
    picture.pixel_mut(3, 2)[1] = f32::NAN;
    write_exr_rgb(&path, &picture).unwrap();
    let error = read_exr_rgb(&path).unwrap_err().to_string();
    assert!(error.contains("column 3, row 2, channel G"), "{error}");
}

#[test]
fn the_data_window_lies_where_the_display_window_has_it() {
    let windows = [([2, 1], [3, 2]), ([5, 0], [8, 4]), ([-3, -2], [14, 9]), ([0, 9], [8, 4])];
    for (corner, size) in windows {
        let (_kept, path) = plain(&[Part("", corner, size, COLOURS)]);
        let picture = read_exr_rgb(&path).unwrap();
        assert_eq!((picture.width, picture.height), (8, 4));
        for y in 0..4 {
            for x in 0..8 {
                let within = |at: usize, axis: usize| {
                    (corner[axis]..corner[axis] + size[axis] as i32).contains(&(at as i32))
                };
                let inside = within(x, 0) && within(y, 1);
                let expected = if inside { full().pixel(x, y).to_vec() } else { vec![0.0; 3] };
                assert_eq!(picture.pixel(x, y), expected, "{corner:?} {x} {y}");
            }
        }
    }
}

#[test]
fn the_part_or_layer_that_holds_the_colour_is_read() {
    let whole = ([0, 0], [8, 4]);
    let depth = || Part("depth", whole.0, whole.1, &["Z"]);
    let colour = |name, channels| Part(name, whole.0, whole.1, channels);
    for parts in [
        vec![depth(), colour("beauty", COLOURS)],
        vec![colour("", &["R", "G", "B", "A", "Z"])],
        vec![colour(
            "",
            &["View.Combined.R", "View.Combined.G", "View.Combined.B", "View.Depth.Z"],
        )],
        vec![colour("a", COLOURS), colour("b", &["diffuse.R", "diffuse.G", "diffuse.B"])],
    ] {
        let (_kept, path) = plain(&parts);
        assert_eq!(read_exr_rgb(&path).unwrap(), full());
        assert!(exr_channel_names(&path).unwrap().iter().any(|name| name == "R"));
    }
    let layers = &["a.R", "a.G", "a.B", "b.c.R", "b.c.G", "b.c.B"];
    for (parts, names) in [
        (vec![colour("left", COLOURS), colour("right", COLOURS)], "left, right"),
        (vec![colour("", layers)], "a, b.c"),
    ] {
        let (_kept, path) = plain(&parts);
        let error = read_exr_rgb(&path).unwrap_err().to_string();
        assert!(error.contains("2 colour layers") && error.contains(names), "{error}");
    }
    let (_kept, path) = plain(&[depth()]);
    let error = read_exr_rgb(&path).unwrap_err().to_string();
    assert!(error.contains("no channel \"R\"; it has Z"), "{error}");
}

#[test]
fn colours_of_other_primaries_are_converted_and_data_are_not() {
    let acescg = [[0.713, 0.293], [0.165, 0.83], [0.128, 0.044], [0.32168, 0.33767]];
    let part = [Part("", [0, 0], [8, 4], COLOURS)];
    let (_kept, path) = write(&part, Some(acescg), LayerAttributes::default());
    assert_eq!(read_exr(&path, COLOURS).unwrap(), full());
    let converted = read_exr_rgb(&path).unwrap();
    let [r, g, b] = <[f32; 3]>::try_from(full().pixel(3, 2)).unwrap();
    let red = 1.70505 * r - 0.62179 * g - 0.08326 * b;
    assert!((converted.pixel(3, 2)[0] - red).abs() < 0.1, "{red} {:?}", converted.pixel(3, 2));
    let reversed = read_exr_colour(&path, &["B", "G", "R"]).unwrap();
    assert_eq!(reversed.pixel(3, 2)[2], converted.pixel(3, 2)[0]);
    let rec709 = [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.31271, 0.32902]];
    let (_kept, path) = write(&part, Some(rec709), LayerAttributes::default());
    assert_eq!(read_exr_rgb(&path).unwrap(), full());
    let (_kept, path) = write(&part, Some([[0.3; 2]; 4]), LayerAttributes::default());
    let error = read_exr_rgb(&path).unwrap_err().to_string();
    assert!(error.contains("not a colour space"), "{error}");
}

#[test]
fn lights_are_latlong_pictures_alone() {
    let (_kept, path) = plain(&[Part("", [0, 0], [8, 2], COLOURS)]);
    let light = read_light(&path).unwrap();
    assert_eq!(light.pixel(3, 1), full().pixel(3, 1));
    assert!(light.pixel(3, 2).iter().all(|value| *value == 0.0));
    let own = LayerAttributes { environment_map: Some(EnvironmentMap::Cube), ..Default::default() };
    let (_kept, path) = write(&[Part("", [0, 0], [8, 4], COLOURS)], None, own);
    let error = read_light(&path).unwrap_err().to_string();
    assert!(error.contains("cube map (envmap = cube)"), "{error}");
    let folder = tempfile::tempdir().unwrap();
    for (width, height, name) in [(16, 16, "probe"), (8, 48, "in a row"), (32, 24, "cross")] {
        let path = folder.path().join("light.exr");
        write_exr_rgb(&path, &Picture::new(width, height, 3)).unwrap();
        let error = read_light(&path).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains("2 : 1"), "{error}");
    }
}

/// Red is the column plus 1, green the row plus 1 as the eye sees them; 3 wide, 2 high.
fn radiance(resolution: &str, lines: &str) -> Vec<u8> {
    let axes: Vec<&str> = resolution.split(' ').collect();
    let size = |axis: &str| if axis.ends_with('Y') { 2u8 } else { 3 };
    let place = |axis: &str, index: u8| match axis {
        "-Y" | "+X" => index,
        _ => size(axis) - 1 - index,
    };
    let mut bytes = format!(
        "#?RADIANCE\n{lines}FORMAT=32-bit_rle_rgbe\n\n{} {} {} {}\n",
        axes[0],
        size(axes[0]),
        axes[1],
        size(axes[1])
    )
    .into_bytes();
    for i in 0..size(axes[0]) {
        for j in 0..size(axes[1]) {
            let (outer, inner) = (place(axes[0], i), place(axes[1], j));
            let (x, y) = if axes[0].ends_with('Y') { (inner, outer) } else { (outer, inner) };
            bytes.extend([x + 1, y + 1, 200, 128 + 8]);
        }
    }
    bytes
}

#[test]
fn radiance_files_come_upright_from_every_orientation() {
    for axes in ["-Y +X", "+Y +X", "-Y -X", "+Y -X", "+X -Y", "+X +Y", "-X -Y", "-X +Y"] {
        let picture = read_radiance_bytes(Path::new("x.hdr"), &radiance(axes, "")).unwrap();
        assert_eq!((picture.width, picture.height), (3, 2), "{axes}");
        assert_eq!(picture.pixel(2, 0), [3.0, 1.0, 200.0], "{axes}");
        assert_eq!(picture.pixel(0, 1), [1.0, 2.0, 200.0], "{axes}");
    }
}

#[test]
fn exposure_and_colour_correction_are_divided_out() {
    let read = |lines: &str| read_radiance_bytes(Path::new("x.hdr"), &radiance("-Y +X", lines));
    let lines = "EXPOSURE=2\nEXPOSURE=4\nCOLORCORR=2 1 .5\n";
    assert_eq!(read(lines).unwrap().pixel(2, 0), [3.0 / 16.0, 1.0 / 8.0, 50.0]);
    let own = "PRIMARIES=.64 .33 .30 .60 .15 .06 .3127 .3290\n";
    assert_eq!(read(own).unwrap(), read("").unwrap());
    let wide = "PRIMARIES=.708 .292 .170 .797 .131 .046 .3127 .3290\n";
    let red = 1.6605 * 3.0 - 0.5876 - 0.0728 * 200.0;
    assert!((read(wide).unwrap().pixel(2, 0)[0] - red).abs() < 3e-2);
    for lines in ["EXPOSURE=0\n", "EXPOSURE=x\n", "COLORCORR=1 1\n", "PRIMARIES=1 2 3\n"] {
        let error = read(lines).unwrap_err().to_string();
        assert!(error.contains(lines.trim()), "{error}");
    }
}

#[test]
fn the_old_run_length_code_is_read() {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 300\n".to_vec();
    // One pixel and 299 times again: 43 + 256.
    bytes.extend([1, 2, 3, 136, 1, 1, 1, 43, 1, 1, 1, 1]);
    let picture = read_radiance_bytes(Path::new("x.hdr"), &bytes).unwrap();
    assert!(picture.data.chunks(3).all(|rgb| rgb == [1.0, 2.0, 3.0]));
    bytes.pop();
    assert!(read_radiance_bytes(Path::new("x.hdr"), &bytes).is_err());
}

#[test]
fn pngs_keep_their_samples_and_name_what_is_no_mask() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mask.png");
    let save = |colour, depth, data: &[u8]| {
        let file = std::fs::File::create(&path).unwrap();
        let mut encoder = png::Encoder::new(file, 2, 2);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        if colour == png::ColorType::Indexed {
            encoder.set_palette(vec![0; 12]);
        }
        encoder.write_header().unwrap().write_image_data(data).unwrap();
    };
    save(png::ColorType::Grayscale, png::BitDepth::One, &[0b0100_0000, 0b1000_0000]);
    assert_eq!(read_png_gray(&path).unwrap().data, [0, 255, 255, 0]);
    assert_eq!(Png::open(&path).unwrap().ids(&path).unwrap().samples, [0, 1, 1, 0]);
    save(png::ColorType::Grayscale, png::BitDepth::Sixteen, &[0, 0, 1, 0, 255, 255, 0, 9]);
    assert_eq!(Png::open(&path).unwrap().samples, [0, 256, 65535, 9]);
    let error = read_png_gray(&path).unwrap_err().to_string();
    assert!(error.contains("found 16-bit grey; save it as 8-bit grey PNG"), "{error}");
    for (colour, bytes, name) in [
        (png::ColorType::Indexed, 4, "a palette"),
        (png::ColorType::GrayscaleAlpha, 8, "grey with alpha"),
        (png::ColorType::Rgb, 12, "RGB"),
    ] {
        save(colour, png::BitDepth::Eight, &vec![0; bytes]);
        let error = read_png_gray(&path).unwrap_err().to_string();
        assert!(error.contains(name), "{error}");
    }
}

#[test]
fn other_kinds_of_files_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("000.jpg");
    std::fs::write(&path, b"\xff\xd8\xff\xe0 and so on").unwrap();
    let error = read_exr_rgb(&path).unwrap_err().to_string();
    assert!(error.contains("is a JPEG; pictures are linear float EXR"), "{error}");
    std::fs::write(&path, b"text").unwrap();
    assert!(read_exr_rgb(&path).unwrap_err().to_string().contains("cannot be read"));
    assert!(read_exr_rgb(folder.path()).unwrap_err().to_string().contains("is not a file"));
}

/// A few thousand damaged files; more in a fuzzer.
#[test]
fn damaged_files_end_in_an_error_or_a_picture() {
    let (_kept, path) =
        plain(&[Part("depth", [1, 1], [3, 2], &["Z"]), Part("beauty", [-2, -1], [12, 6], COLOURS)]);
    let mut seeds = vec![std::fs::read(&path).unwrap(), radiance("-Y +X", "EXPOSURE=2\n")];
    let png = path.with_extension("png");
    write_png_gray(&png, &GrayImage::new(7, 5)).unwrap();
    seeds.push(std::fs::read(&png).unwrap());
    let mut state = 1u32;
    let mut random = |below: usize| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as usize % below
    };
    for round in 0..3000 {
        let mut bytes = seeds[round % seeds.len()].clone();
        for _ in 0..1 + random(4) {
            let at = random(bytes.len());
            bytes[at] = [0, 1, 127, 255, random(256) as u8][random(5)];
        }
        if random(8) == 0 {
            bytes.truncate(random(bytes.len()));
        }
        let path = Path::new("damaged");
        let _ = ExrFile::from_bytes(path, bytes.clone())
            .and_then(|file| file.read(COLOURS, Content::Colour));
        let _ = read_radiance_bytes(path, &bytes);
        let _ = Png::from_bytes(path, &bytes);
    }
}

#[test]
fn a_message_is_one_line_whatever_a_channel_is_called() {
    let (_kept, path) = plain(&[Part("", [0, 0], [8, 4], &["G", "a\nb"])]);
    let message = read_exr(&path, &["R"]).unwrap_err().to_string();
    assert!(message.ends_with("it has G, a b"), "{message}");
}
