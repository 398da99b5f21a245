//! Highlights and their derivatives with respect to the normal.

use glam::Vec3;

use super::matrix::Matrix;
use super::reflection::scale;
use super::skin::{GRAZING, lobe_slopes, schlick};
use super::{CHANNELS, SpecularTerm, Transport, luminance};
use crate::config::SkinConfig;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::simd::widened;

/// Rows of [`SkinHighlights::on`]: R, G, B, and the derivatives of the luminance with respect to the normal's x, y, z.
pub const HIGHLIGHT_ROWS: usize = CHANNELS + 3;
/// Cells that one vector instruction sums.
const LANES: usize = 16;
/// Least squared length of the sum of two directions.
const OPPOSITE: f32 = 1e-12;

/// A light and its visible solid angles, for highlights of skin with any normals.
#[derive(Clone)]
pub struct SkinHighlights<'a> {
    transport: &'a Transport,
    skin: &'a SkinConfig,
    visible_solid_angle: &'a Matrix,
    cells: Vec<Cells>,
    scale: f32,
}

impl Transport {
    /// Highlights of a light of R, G, B per cell, in units of a `peak`: its own [`Self::peak`], or that of the light
    /// for which the reflectances hold. The light is filtered with this power of the cosine, usually
    /// [`LIGHT_EXPONENT`](super::LIGHT_EXPONENT).
    pub fn skin_highlights<'a>(
        &'a self,
        skin: &'a SkinConfig,
        light: &[f32],
        peak: f32,
        exponent: i32,
    ) -> SkinHighlights<'a> {
        let scale = scale(skin, peak);
        let light = self.through_lobes(light, exponent);
        let mut cells = vec![[[0.0; LANES]; CELL]; self.cells().div_ceil(LANES)];
        for (cell, (centre, light)) in self.sky.centres().iter().zip(&light).enumerate() {
            let [r, g, b] = *light;
            let row = [centre.x, centre.y, centre.z, r, g, b, luminance(light)];
            (0..CELL).for_each(|k| cells[cell / LANES][k][cell % LANES] = row[k]);
        }
        let visible_solid_angle = &self.visible_solid_angle;
        SkinHighlights { transport: self, skin, visible_solid_angle, cells, scale }
    }
}

impl SkinHighlights<'_> {
    /// The specular radiance from every sample to its camera, with these unit normals and [`SpecularTerm`] terms, and
    /// its derivatives with respect to the normal, whose component along the normal counts as well;
    /// [`HIGHLIGHT_ROWS`] rows.
    pub fn on(&self, samples: &Samples, normals: &Planes, specular: &Planes) -> Planes {
        let Self { transport, skin, visible_solid_angle, cells, scale } = self;
        Planes::from_fn(samples.len(), |i| {
            let row = transport.row_of(samples, i);
            let place = Place {
                normal: Vec3::from_array(normals.sample(i, 0)),
                view: Vec3::from_array(samples.view.sample(i, 0)),
                from: transport.sky.nearness * transport.places[row],
            };
            let mut sums = [0.0; HIGHLIGHT_ROWS];
            let count = visible_solid_angle.cells;
            let visible = &visible_solid_angle.rows[row * count..][..count];
            let specular = SpecularTerm::at(specular, i);
            sum_lobes(&specular.lobes_of(skin), cells, visible, &place, &mut sums);
            sums.map(|sum| specular.reflectance * (scale * sum))
        })
    }

    /// Returns the data that a device needs for [`Self::on`].
    pub(crate) fn parts(&self, samples: &Samples) -> SkinHighlightParts<'_> {
        let Self { transport, skin, visible_solid_angle, cells, scale } = self;
        SkinHighlightParts {
            cells: cells.as_flattened().as_flattened(),
            visible_solid_angle: &visible_solid_angle.rows,
            row: (0..samples.len()).map(|i| transport.row_of(samples, i) as u32).collect(),
            from: transport.places.iter().map(|place| transport.sky.nearness * *place).collect(),
            scale: *scale,
            guards: [GRAZING, OPPOSITE],
            skin,
        }
    }
}

/// See [`SkinHighlights::parts`].
pub(crate) struct SkinHighlightParts<'a> {
    /// In blocks of 16 cells, seven rows each: direction from the sky's centre, R, G, B, luminance.
    pub cells: &'a [f32],
    /// Rows of as many weights as there are cells.
    pub visible_solid_angle: &'a [f32],
    /// The row of every sample.
    pub row: Vec<u32>,
    /// The place of every row, in units of the sky's radius.
    pub from: Vec<Vec3>,
    /// Factor on the result.
    pub scale: f32,
    /// Least cosine of the view, least squared length of a sum of directions.
    pub guards: [f32; 2],
    pub skin: &'a SkinConfig,
}

/// Values of a cell: its direction from the sky's centre, R, G, B, luminance.
const CELL: usize = 2 * CHANNELS + 1;
type Cells = [[f32; LANES]; CELL];

/// Where a sample lies.
struct Place {
    normal: Vec3,
    view: Vec3,
    /// The position from the sky's centre, in units of the sky's radius.
    from: Vec3,
}

widened! {
    /// Sums [`HIGHLIGHT_ROWS`] rows over the visible cells.
    fn sum_lobes(skin: &SkinConfig, cells: &[Cells], visible: &[f32], place: &Place, sums: &mut [f32; HIGHLIGHT_ROWS]) {
        let skin = *skin;
        let Place { normal: n, view: v, from } = *place;
        let nv = n.dot(v).max(GRAZING);
        let mut lanes = [[0.0f32; LANES]; HIGHLIGHT_ROWS];
        for (block, cells) in cells.iter().enumerate() {
            let first = block * LANES;
            let mut here = [0.0; LANES];
            let some = (visible.len() - first).min(LANES);
            here[..some].copy_from_slice(&visible[first..first + some]);
            // Half of the sky is behind the surface.
            if here == [0.0; LANES] {
                continue;
            }
            for lane in 0..LANES {
                let l = Vec3::new(cells[0][lane], cells[1][lane], cells[2][lane]) - from;
                let l = l * (1.0 / l.length_squared().max(OPPOSITE).sqrt());
                let h = v + l;
                let h = h * (1.0 / h.length_squared().max(OPPOSITE).sqrt());
                let (nl, c, vh) = (n.dot(l), n.dot(h), v.dot(h));
                let towards = if nl > 0.0 { here[lane] } else { 0.0 };
                let nl = nl.max(0.0);
                let [value, by_c, by_nv, by_nl] = lobe_slopes(&skin, c, nv, nl);
                let weight = towards * schlick(skin.f0, vh);
                let by = (h * by_c + v * by_nv + l * by_nl) * (weight * cells[6][lane]);
                let value = weight * value;
                lanes[0][lane] += value * cells[3][lane];
                lanes[1][lane] += value * cells[4][lane];
                lanes[2][lane] += value * cells[5][lane];
                lanes[3][lane] += by.x;
                lanes[4][lane] += by.y;
                lanes[5][lane] += by.z;
            }
        }
        for (sum, lanes) in sums.iter_mut().zip(&lanes) {
            for lane in lanes {
                *sum += lane;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use capture::gbuffer::GBuffer;

    use super::*;
    use crate::config::{TransportConfig, UnshadeConfig};
    use crate::model::samples::SampleSpace;
    use crate::testing;
    use crate::transport::{LIGHT_EXPONENT, Sky};

    const NEARNESS: f32 = 0.7;

    /// A dome under a coloured light 1.4 metres away, seen by two cameras.
    fn scene() -> (Transport, Vec<f32>, Samples) {
        let (mesh, config) = (testing::dome(16), UnshadeConfig::default());
        let t = TransportConfig { texture_size: 32, rows: 6, ..config.transport.clone() };
        let sky = Sky::lat_long(t.rows).at(NEARNESS);
        let transport = Transport::new(&mesh, &sky, &t, 3);
        let light = (0..CHANNELS * transport.cells()).map(|i| 1.0 + (i as f32 * 1.7).sin());
        let shade = |_| (Vec3::ONE, 1);
        let views: Vec<_> =
            testing::rig(2, 40).iter().map(|camera| testing::view(&mesh, camera, shade)).collect();
        let gbuffers = GBuffer::of_views(&mesh, &views);
        let samples = SampleSpace::default().training(&views, &gbuffers, None, 64);
        (transport, light.collect(), samples)
    }

    /// Terms that differ from sample to sample.
    fn terms(count: usize) -> Planes {
        Planes::from_fn(count, |i| {
            let [reflectance, roughness] = [0.9, 1.4].map(|k| 1.0 + 0.3 * (i as f32 * k).sin());
            SpecularTerm { reflectance, roughness }.channels()
        })
    }

    #[test]
    fn highlights_are_what_the_light_is_solved_for_with() {
        let (transport, light, samples) = scene();
        let terms = terms(samples.len());
        let (skin, peak) = (UnshadeConfig::default().skin, transport.peak(&light));
        let rows = transport.reflection(&skin, &samples, &terms, peak, NEARNESS);
        let highlights = transport.skin_highlights(&skin, &light, peak, LIGHT_EXPONENT);
        let found = highlights.on(&samples, &samples.normal, &terms);
        assert!(samples.len() > 500);
        for (i, expected) in rows.radiance(&light).into_iter().enumerate() {
            for (c, expected) in expected.into_iter().enumerate() {
                let found = found.get(c, i);
                assert!((expected - found).abs() < 1e-4 * expected.max(1e-3), "{expected} {found}");
            }
        }
    }

    #[test]
    fn slopes_are_those_of_finite_differences() {
        let (transport, light, samples) = scene();
        let (skin, peak) = (UnshadeConfig::default().skin, transport.peak(&light));
        const STEP: f32 = 2e-3;
        let highlights = transport.skin_highlights(&skin, &light, peak, LIGHT_EXPONENT);
        let terms = terms(samples.len());
        let along = |axis: Vec3, step: f32| {
            let normal = |i: usize| {
                let normal = Vec3::from_array(samples.normal.sample(i, 0));
                (normal + step * (axis - normal * normal.dot(axis))).to_array()
            };
            let normals = Planes::from_fn(samples.len(), normal);
            let bent = highlights.on(&samples, &normals, &terms);
            move |i: usize| luminance::<f32>(&bent.sample::<CHANNELS>(i, 0))
        };
        let bent = highlights.on(&samples, &samples.normal, &terms);
        for axis in [Vec3::X, Vec3::Y] {
            let (ahead, behind) = (along(axis, STEP), along(axis, -STEP));
            let (mut error, mut energy) = (0.0, 0.0);
            for i in 0..samples.len() {
                let normal = Vec3::from_array(samples.normal.sample(i, 0));
                let expected = (ahead(i) - behind(i)) / (2.0 * STEP);
                let found = Vec3::from_array(bent.sample(i, CHANNELS));
                let found = found.dot(axis - normal * normal.dot(axis));
                error += (expected - found).abs();
                energy += expected.abs();
            }
            assert!(energy > 1.0 && error < 0.01 * energy, "{axis}: {error} of {energy}");
        }
    }
}
