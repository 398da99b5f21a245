//! Semantic initialisation of the diffuse albedo (paper, section 5.3): every region of the face has its mean colour.

mod cell_light;
mod chart;
mod clusters;
mod colours;
mod explanation;
mod hair;
mod lamps;
mod merging;
mod part_of_skin;
mod parts;
pub(crate) mod regions;
mod settings;

use capture::gbuffer::{Atlas, GBuffer};
use capture::projection::{Observation, Projection, per_texel};
use capture::{Mesh, View};
use formats::fill;
use formats::picture::Picture;
use glam::{DVec3, Vec3};

use crate::config::ViewWeightConfig;
use crate::view_weights::view_weights;

/// Added to every pixel's weight, so that a region of pixels with zero weight still has a mean.
const LEAST_WEIGHT: f32 = 1e-4;

/// The initial diffuse albedo: linear RGB on a square map of `size` texels, in the unit of the pictures (radiance, not
/// reflectance). The G-buffers are those of the views.
///
/// A texel has the label with the largest sum of cosines over the views; a texel without a label in any view has that
/// of the nearest labelled texel. Without labels the face is one region. All labels `alike` have the colour of the one
/// with the largest weight in the views.
pub fn initial_diffuse_albedo(
    mesh: &Mesh,
    views: &[View],
    gbuffers: &[GBuffer],
    weights: &ViewWeightConfig,
    size: usize,
    alike: &[u8],
) -> Picture {
    let atlas = Atlas::new(mesh, size);
    let regions = region_map(&atlas, &Projection::of_views(views, gbuffers));
    let colours = region_colours(views, gbuffers, weights, alike);
    let data = regions.iter().flat_map(|region| colours[*region as usize].to_array()).collect();
    Picture { width: size, height: size, channels: 3, data }
}

/// The region of every texel; 0 only if no view has labels.
pub fn region_map(atlas: &Atlas, projections: &[Projection]) -> Vec<u8> {
    let vote = |seen: &[(usize, Observation)]| {
        let mut votes = [0.0_f32; 256];
        for (view, observation) in seen {
            let view = projections[*view].view;
            let [x, y] = observation.at.map(|value| value as usize);
            votes[view.label(y * view.camera.width + x) as usize] += observation.cosine;
        }
        // The smaller id wins a tie.
        (1..=255_u8).fold(0, |best, id| {
            let (most, votes) = (votes[best as usize], votes[id as usize]);
            if votes > 0.0 && (best == 0 || votes > most) { id } else { best }
        })
    };
    let regions = per_texel(atlas, projections, vote);
    let known: Vec<bool> = regions.iter().map(|region| *region != 0).collect();
    let nearest = fill::nearest_known(&known, atlas.size, atlas.size);
    nearest.into_iter().map(|texel| regions[texel as usize]).collect()
}

/// The mean colour of the pixels of every region, weighted by the form factor; region 0 is the mean over all pixels.
/// The regions `alike` have the colour of the one with the largest weight.
fn region_colours(
    views: &[View],
    gbuffers: &[GBuffer],
    weights: &ViewWeightConfig,
    alike: &[u8],
) -> [Vec3; 256] {
    let mut sums = [DVec3::ZERO; 256];
    let mut totals = [0.0_f64; 256];
    for (view, gbuffer) in views.iter().zip(gbuffers) {
        let weights = view_weights(gbuffer, weights);
        for (pixel, weight) in gbuffer.pixels.iter().zip(weights) {
            let pixel = *pixel as usize;
            let colour = Vec3::from_slice(&view.image.data[3 * pixel..]).as_dvec3();
            let weight = f64::from(weight + LEAST_WEIGHT);
            let region = view.label(pixel);
            let all = (region != 0).then_some(0);
            for region in all.into_iter().chain([region as usize]) {
                sums[region] += weight * colour;
                totals[region] += weight;
            }
        }
    }
    let most = alike.iter().copied().max_by(|a, b| {
        let [a, b] = [a, b].map(|region| totals[*region as usize]);
        a.total_cmp(&b)
    });
    std::array::from_fn(|region| {
        let own = !alike.contains(&(region as u8));
        let region = most.filter(|_| !own).map_or(region, usize::from);
        if totals[region] > 0.0 { (sums[region] / totals[region]).as_vec3() } else { Vec3::ZERO }
    })
}

#[cfg(test)]
mod tests;
