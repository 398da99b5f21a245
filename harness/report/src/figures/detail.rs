//! Detail transfer: how much of the albedo's detail a method recovers, by its size. A band of the brightness is the
//! difference of two Gaussian blurs, one octave apart, within the scored texels of the skin. What of the truth's band
//! is in the recovered one is the projection ⟨p, g⟩ / ⟨g, g⟩ (1: all of it, 0: nothing or something else); how much
//! of the recovered band is the truth's is their correlation, which shading left in a map lowers. Their amplitudes'
//! ratio stands beside both in the CSV.

mod bands;

use formats::picture::{Content, GrayImage, Picture};
use scoring::metrics::resample;
use serde_json::json;

use self::bands::{Band, Bands};
use super::drawing::{Block, Drawing, Lines, PanelRow, Panels};
use super::mesh_scale::texel_millimetres;
use super::panels::brightness;
use super::source::{CaseSource, Sources};
use super::statistics::curve;
use crate::comparison_figures::{read_if_present, read_mask_if_present};
use crate::error::ReportError;
use crate::tone;

const ALBEDO: &str = "diffuse_albedo.exr";
const RGB: &[&str] = &["R", "G", "B"];
/// A crop's share of the map's side.
const CROP: usize = 5;

/// The detail that one method recovers in one band of one case.
struct Transfer {
    method: usize,
    face: String,
    band: usize,
    frequency: f64,
    ratio: Ratio,
}

pub(super) fn draw(sources: &Sources, drawing: &mut Drawing) -> Result<(), ReportError> {
    let mut methods: Vec<(String, String)> = Vec::new();
    let mut found: Vec<Transfer> = Vec::new();
    let mut crops: Option<Panels> = None;
    for source in sources.cases() {
        let path = source.truth(ALBEDO);
        let Some(truth) = read_if_present(&path, RGB, Content::Colour)? else { continue };
        let Some(mask) = read_mask_if_present(&source.truth("coverage.png"))? else { continue };
        let labels = read_mask_if_present(&source.truth("labels.png"))?;
        let mask = within_one_region(mask, labels.as_ref());
        let inside: Vec<bool> = mask.data.iter().map(|value| *value > 0).collect();
        let mesh = source.run.join(&source.case.capture).join("mesh.obj");
        let texel = texel_millimetres(&mesh, truth.width)?;
        let bands = Bands::new(&inside, truth.width);
        let exact = bands.of(&brightness(&truth));
        let mut shown = vec![("truth".to_owned(), truth.clone())];
        for column in source.columns.iter().filter(|column| sources.lists(column)) {
            let Some(path) = source.map(column, ALBEDO) else { continue };
            let Some(map) = read_if_present(&path, RGB, Content::Colour)? else { continue };
            let mut map = resample(&map, truth.width, truth.height);
            let factor = column.factor().unwrap_or(1.0);
            map.data.iter_mut().for_each(|value| *value *= factor as f32);
            let known = methods.iter().position(|(id, _)| *id == column.method.id);
            let method = known.unwrap_or_else(|| {
                methods.push((column.method.id.clone(), column.method.title().to_owned()));
                methods.len() - 1
            });
            let made = bands.of(&brightness(&map));
            for (band, (made, exact)) in made.iter().zip(&exact).enumerate() {
                let Some(ratio) = compare(made, exact, &inside) else { continue };
                let frequency = exact.cycles_per_texel() / texel;
                drawing.row(json!({
                    "case": source.case.id, "face": source.case.face, "method": column.method.id,
                    "cycles per mm": frequency, "blur, texels": exact.blur, "gain": ratio.gain,
                    "amplitude": ratio.amplitude, "correlation": ratio.correlation,
                }));
                let face = source.case.face.clone();
                found.push(Transfer { method, face, band, frequency, ratio });
            }
            shown.push((column.method.title().to_owned(), map));
        }
        if crops.is_none() && shown.len() > 1 {
            crops = Some(cropped(drawing, &source, &shown, &exact, &mask)?);
        }
    }
    if found.is_empty() {
        return Err(sources.nothing("the albedo map of a rendered face"));
    }
    type Quantity = fn(&Transfer) -> f64;
    let plots: [(&str, Quantity); 2] = [
        ("recovered amplitude", |transfer| transfer.ratio.gain),
        ("correlation with the truth", |transfer| transfer.ratio.correlation),
    ];
    let count = found.iter().map(|transfer| transfer.band + 1).max().unwrap_or(0);
    for (title, quantity) in plots {
        let line = |(method, (_, title)): (usize, &(String, String))| {
            // From coarse to fine.
            curve(title, (0..count).rev(), |band| {
                let here = found.iter().filter(|t| t.method == method && t.band == band);
                here.map(|t| (t.face.clone(), t.frequency, quantity(t))).collect()
            })
        };
        let lines = methods.iter().enumerate().map(line).collect();
        drawing.blocks.push(Block::Lines(Lines {
            title: title.to_owned(),
            x_label: "spatial frequency, cycles per mm".to_owned(),
            y_label: String::new(),
            logarithmic: true,
            across: vec![0.0, 1.0],
            lines,
        }));
    }
    drawing.blocks.extend(crops.map(Block::Panels));
    drawing.caption = "Detail transfer: the share of the true albedo's detail within the skin that is in the recovered map, by its \
                       spatial frequency (projection of octave bands of the brightness; 1 is all), and the correlation of \
                       the two; means over faces with the 95 % interval of Student's t. Below, the crop with the most \
                       detail, after one factor."
        .to_owned();
    Ok(())
}

/// The part of the mask in its largest region, which is skin: the edges of brows and hair are larger than any detail,
/// and a flat map with the right regions has them. All of it where no regions are known.
fn within_one_region(mut mask: GrayImage, labels: Option<&GrayImage>) -> GrayImage {
    let same = |labels: &&GrayImage| (labels.width, labels.height) == (mask.width, mask.height);
    let Some(labels) = labels.filter(same) else { return mask };
    let mut counts = [0_usize; 256];
    for (label, inside) in labels.data.iter().zip(&mask.data) {
        counts[usize::from(*label)] += usize::from(*inside > 0);
    }
    let largest = (0..256).max_by_key(|label| counts[*label]);
    for (label, inside) in labels.data.iter().zip(&mut mask.data) {
        if Some(usize::from(*label)) != largest {
            *inside = 0;
        }
    }
    mask
}

/// A band of a map against that of the truth.
struct Ratio {
    gain: f64,
    amplitude: f64,
    correlation: f64,
}

/// Compares a band with that of the truth; `None` where the truth has nothing in the band.
fn compare(made: &Band, exact: &Band, inside: &[bool]) -> Option<Ratio> {
    let (mut pp, mut pg, mut gg) = (0.0, 0.0, 0.0);
    for ((p, g), inside) in made.values.iter().zip(&exact.values).zip(inside) {
        if *inside {
            pp += p * p;
            pg += p * g;
            gg += g * g;
        }
    }
    // Rounding of half floats leaves some.
    let count = inside.iter().filter(|inside| **inside).count().max(1) as f64;
    (gg / count > 1e-10).then(|| Ratio {
        gain: pg / gg,
        amplitude: (pp / gg).sqrt(),
        correlation: if pp > 0.0 { pg / (pp * gg).sqrt() } else { 0.0 },
    })
}

/// The square of the map whose finer bands hold the most, of every map.
fn cropped(
    drawing: &Drawing,
    source: &CaseSource,
    shown: &[(String, Picture)],
    exact: &[Band],
    mask: &GrayImage,
) -> Result<Panels, ReportError> {
    let side = (mask.width / CROP).max(16).min(mask.width).min(mask.height);
    let energy = |left: usize, top: usize| -> f64 {
        let rows = top..top + side;
        let fine = exact.iter().take(3);
        let whole =
            rows.clone().all(|y| (left..left + side).all(|x| mask.data[y * mask.width + x] > 0));
        if !whole {
            return -1.0;
        }
        let of = |band: &Band| -> f64 {
            rows.clone()
                .flat_map(|y| &band.values[y * mask.width + left..y * mask.width + left + side])
                .map(|value| value * value)
                .sum()
        };
        fine.map(of).sum()
    };
    let step = (side / 4).max(1);
    let places = (0..=mask.height - side).step_by(step);
    let places = places.flat_map(|y| (0..=mask.width - side).step_by(step).map(move |x| (x, y)));
    let best = places.map(|(x, y)| (energy(x, y), x, y)).max_by(|a, b| a.0.total_cmp(&b.0));
    let (_, left, top) = best.unwrap_or((0.0, 0, 0));
    let mut cells = Vec::new();
    for (at, (_, map)) in shown.iter().enumerate() {
        let mut crop = Picture::new(side, side, map.channels);
        for y in 0..side {
            for x in 0..side {
                crop.pixel_mut(x, y).copy_from_slice(map.pixel(left + x, top + y));
            }
        }
        let name = format!("{}-crop-{at:02}", source.case.id);
        cells.push(Some(drawing.panel(&name, &tone::colour(&crop, 1.0), String::new())?));
    }
    let title = format!(
        "{}, {}: texels {left} to {} across, {top} to {} down",
        source.face(),
        source.case.light,
        left + side,
        top + side
    );
    let columns = shown.iter().map(|(title, _)| title.clone()).collect();
    Ok(Panels { title, columns, rows: vec![PanelRow { title: String::new(), cells }], error: None })
}
