//! Highlights, and how they change with the normal.

use glam::Vec3;

use super::matrix::Matrix;
use super::reflection::scale;
use super::skin::{GRAZING, lobe_slopes, schlick};
use super::{CHANNELS, LIGHT_EXPONENT, LUMINANCE, SpecularTerm, Transport};
use crate::config::SkinConfig;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::simd::widened;

/// Rows of [`SkinHighlights::on`]: R, G, B, and how the luminance changes with the normal's x, y, z.
pub const HIGHLIGHT_ROWS: usize = CHANNELS + 3;
/// Cells that are summed beside each other.
const LANES: usize = 16;
/// Least squared length of the sum of two directions.
const OPPOSITE: f32 = 1e-12;

/// A light and its visibility, which make highlights on skin of any normals.
#[derive(Clone)]
pub struct SkinHighlights<'a> {
    transport: &'a Transport,
    skin: &'a SkinConfig,
    open: &'a Matrix,
    cells: Vec<Cells>,
    scale: f32,
}

impl Transport {
    /// Highlights of a light of R, G, B per cell, scaled so that its [`Self::peak`] is 1.
    pub fn skin_highlights<'a>(
        &'a self,
        skin: &'a SkinConfig,
        light: &[f32],
    ) -> SkinHighlights<'a> {
        self.skin_highlights_through(skin, light, LIGHT_EXPONENT)
    }

    /// Likewise, with the light seen through another lobe than the transport's own.
    pub fn skin_highlights_through<'a>(
        &'a self,
        skin: &'a SkinConfig,
        light: &[f32],
        exponent: i32,
    ) -> SkinHighlights<'a> {
        let scale = scale(skin, self.peak(light));
        let light = self.through_lobes(light, exponent);
        let mut cells = vec![[[0.0; LANES]; CELL]; self.cells().div_ceil(LANES)];
        for (cell, (centre, light)) in self.sky.centres().iter().zip(&light).enumerate() {
            let luminance = light.iter().zip(LUMINANCE).map(|(l, w)| l * w).sum();
            let [r, g, b] = *light;
            let row = [centre.x, centre.y, centre.z, r, g, b, luminance];
            (0..CELL).for_each(|k| cells[cell / LANES][k][cell % LANES] = row[k]);
        }
        SkinHighlights { transport: self, skin, open: &self.open, cells, scale }
    }
}

impl SkinHighlights<'_> {
    /// Radiance that skin of these [`SpecularTerm`] terms sends to the camera of every sample, on these normals (unit),
    /// and how it changes with the normal, along the surface and across it; [`HIGHLIGHT_ROWS`] rows.
    pub fn on(&self, samples: &Samples, normals: &Planes, specular: &Planes) -> Planes {
        let Self { transport, skin, open, cells, scale } = self;
        Planes::from_fn(samples.len(), |i| {
            let row = transport.row_of(samples, i);
            let seen = Seen {
                normal: Vec3::from_array(normals.sample(i, 0)),
                view: Vec3::from_array(samples.view.sample(i, 0)),
                from: transport.sky.nearness * transport.places[row],
            };
            let mut sums = [0.0; HIGHLIGHT_ROWS];
            let open = &open.rows[row * open.cells..][..open.cells];
            let specular = SpecularTerm::at(specular, i);
            sum_lobes(&specular.lobes_of(skin), cells, open, &seen, &mut sums);
            sums.map(|sum| specular.reflectance * (scale * sum))
        })
    }

    /// For a device that does the same.
    pub(crate) fn parts(&self, samples: &Samples) -> SkinHighlightParts<'_> {
        let Self { transport, skin, open, cells, scale } = self;
        SkinHighlightParts {
            cells: cells.as_flattened().as_flattened(),
            open: &open.rows,
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
    pub open: &'a [f32],
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

struct Seen {
    normal: Vec3,
    view: Vec3,
    /// The place in units of the sky's radius.
    from: Vec3,
}

widened! {
    /// Sums [`HIGHLIGHT_ROWS`] rows over the cells that are open.
    fn sum_lobes(skin: &SkinConfig, cells: &[Cells], open: &[f32], seen: &Seen, sums: &mut [f32; HIGHLIGHT_ROWS]) {
        let skin = *skin;
        let Seen { normal: n, view: v, from } = *seen;
        let nv = n.dot(v).max(GRAZING);
        let mut lanes = [[0.0f32; LANES]; HIGHLIGHT_ROWS];
        for (block, cells) in cells.iter().enumerate() {
            let first = block * LANES;
            let mut here = [0.0; LANES];
            let some = (open.len() - first).min(LANES);
            here[..some].copy_from_slice(&open[first..first + some]);
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
    use crate::transport::Sky;

    const NEARNESS: f32 = 0.7;

    /// A dome under a coloured light 1.4 metres away, seen by two cameras.
    fn scene() -> (Transport, Vec<f32>, Samples) {
        let (mesh, config) = (testing::dome(16), UnshadeConfig::default());
        let t = TransportConfig { texture_size: 32, rows: 6, ..config.transport.clone() };
        let sky = Sky::even(t.rows).at(NEARNESS);
        let transport = Transport::new(&mesh, &sky, &t, 3);
        let light = (0..CHANNELS * transport.cells()).map(|i| 1.0 + (i as f32 * 1.7).sin());
        let shade = |_| (Vec3::ONE, 1);
        let views: Vec<_> =
            testing::rig(2, 40).iter().map(|camera| testing::view(&mesh, camera, shade)).collect();
        let gbuffers = GBuffer::of_views(&mesh, &views);
        let space = SampleSpace::new(&mesh, 1.0);
        let samples = space.training(&views, &gbuffers, None, 64);
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
        let highlights = transport.skin_highlights(&skin, &light);
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
        let skin = UnshadeConfig::default().skin;
        const STEP: f32 = 2e-3;
        let highlights = transport.skin_highlights(&skin, &light);
        let terms = terms(samples.len());
        let along = |axis: Vec3, step: f32| {
            let normal = |i: usize| {
                let normal = Vec3::from_array(samples.normal.sample(i, 0));
                (normal + step * (axis - normal * normal.dot(axis))).to_array()
            };
            let normals = Planes::from_fn(samples.len(), normal);
            let bent = highlights.on(&samples, &normals, &terms);
            move |i: usize| (0..CHANNELS).map(|c| LUMINANCE[c] * bent.get(c, i)).sum::<f32>()
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
