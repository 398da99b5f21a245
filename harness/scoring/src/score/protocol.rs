//! The protocol, in words, as every scores file carries it.

use serde::{Deserialize, Serialize};

/// Renderer, in `relit.json`, of pictures that a method relit itself.
pub(super) const OWN: &str = "own";

/// The protocol of the numbers; changes of meaning get another id.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Protocol {
    /// The name.
    pub id: String,
    /// The rules, in sentences.
    pub statements: Vec<String>,
}

impl Protocol {
    /// The protocol of this version for a truth that `render` says how it was rendered: a scene's
    /// table of that name.
    pub fn of(render: Option<&toml::Table>) -> Self {
        let mut id = "unshade-1".to_owned();
        let mut statements = STATEMENTS.map(str::to_owned).to_vec();
        let said = |key: &str| render?.get(key)?.as_str();
        if let Some(tier @ ("diffusion" | "volume")) = said("tier") {
            id.push_str(&format!(" {tier}"));
            statements.push(format!(
                "tier {tier}: truth and relit maps have subsurface scattering; these scores do not compare with scores of other tiers."
            ));
        }
        if let Some(denoiser @ "oidn") = said("denoise") {
            id.push_str(&format!(" {denoiser}"));
            statements.push(format!(
                "denoise {denoiser}: true and relit pictures were denoised. The floors are those of the noisy pictures, so a perfect solver may exceed them, and detail finer than the noise is the denoiser's."
            ));
        }
        Self { id, statements }
    }

    /// This protocol for pictures that another renderer than the truth's relit.
    pub fn relit_by(mut self, renderer: Option<&str>) -> Self {
        if let Some(renderer @ "cycles") = renderer {
            self.id.push_str(&format!(" {renderer}"));
            self.statements.push(format!(
                "relit by {renderer}: maps were relit by another renderer than the truth; differences between the renderers count as errors of every method."
            ));
        }
        if let Some(renderer @ OWN) = renderer {
            self.id.push_str(&format!(" {renderer}"));
            self.statements.push(format!(
                "relit by {renderer}: the method relit the withheld views itself, given the lights; no maps were relit. Without an albedo to scale, mode global multiplies its pictures by one factor for all lights and frames, k = <p,g>/<p,p> on linear values over mask-e5."
            ));
        }
        self
    }

    /// The protocol of captures without a truth, whose exposures may be unknown.
    pub fn of_photographs(has_unknown_exposure: bool) -> Self {
        let mut statements = PHOTOGRAPHS.map(str::to_owned).to_vec();
        let mut id = "unshade-photographs-1".to_owned();
        if has_unknown_exposure {
            id.push_str(" own-gains");
            statements.push(
                "own-gains: the exposures of the photographs are unknown, so that every picture is scaled by one factor per frame and channel, k = <p,g>/<p,p> on linear values over mask-e5; these scores do not compare with scores of known exposures.".to_owned(),
            );
        }
        Self { id, statements }
    }
}

const PHOTOGRAPHS: [&str; 5] = [
    "There is no truth, so maps are not scored by themselves. Pictures are compared with withheld photographs, linear and undistorted; the error includes their noise, clipping and exposure.",
    "Pictures are compared on the mask eroded once by 5x5: mask-e5; mask-rim is the part that erosion removes. Both pictures are black outside the uneroded mask, which is a file, or the mesh's silhouette without one.",
    "view: the method's own synthesis of a withheld view. relit: its maps path-traced in its recovered light, on the capture's mesh without other geometry. A wrong light with a wrong albedo can still fit.",
    "Frames are pooled: a PSNR is that of the mean squared error over the pixels of all withheld frames; per_frame has each frame alone. No picture and no map is scaled.",
    "ci95: percentiles 2.5 and 97.5 of 1000 bootstrap resamples of blocks of pixels, pooled over frames, fixed seed; block is their side, four times the distance at which the errors' correlation falls to 1/e.",
];

const STATEMENTS: [&str; 15] = [
    "Maps are compared on the texels that at least one training view sees (truth/coverage.png), eroded once by 5x5: coverage-e5. Metrics named _area weight every texel by its surface area. coverage-e5-views2 is the part that at least two views see.",
    "coverage-e5-0.5mm, -1mm, -2mm, -4mm: map and truth are averaged by area over cells of the surface first, the cubes of a grid of that side, in which normals nearest to different axes are apart. Maps of different sizes and charts compare there.",
    "Maps of another size than the truth are sampled bilinearly at the truth's texel centres, clamped at the border; normals are renormalised.",
    "Pictures are compared on the pixels where the face is the first surface (masks/), eroded once by 5x5: mask-e5. Both pictures are black outside the uneroded mask.",
    "Frames are pooled: a PSNR is that of the mean squared error over the pixels of all withheld frames, a mean is over all their pixels; per_frame has each frame alone.",
    "Scale modes of the diffuse albedo: none; global k = <p,g>/<p,p>; channel, the same per channel; median of g/p per channel. Fitted on linear values over coverage-e5. Relit pictures of mode global are rendered again with the scaled albedo; pictures are never scaled.",
    "A metric that is not defined (the correlation with a constant) is null. A subject whose map, view or picture a solver did not write has no rows.",
    "ci95: percentiles 2.5 and 97.5 of 1000 bootstrap resamples of square blocks, pooled over frames, fixed seed; block is their side in texels or pixels, four times the distance at which the errors' correlation falls to 1/e, from 4 to a fifth of the region, or more if a row would have more than about 2000 blocks; texel_mm of a region is the size of a texel on the face. The interval covers the choice of the part of the face, not of faces, lights or seeds.",
    "floor: the score of a perfect solver given the Monte Carlo noise of truth and relit picture (for view: of the truth alone), from the variances of their pixel means, propagated through clipping and the sRGB curve by five-point Gauss-Hermite quadrature.",
    "*_unbiased: pictures have two independent halves of their samples, and the mean product of the errors of both halves is free of noise; this is exact for linear values. For sRGB values the curve leaves a bias where truth and picture are not equally noisy or bright; docs/statistics.md quantifies it. Absent if a picture has no halves (an odd number of passes, a denoiser, another renderer).",
    "orb_*, owl_*, nerfactor_*: protocols of other benchmarks on unchanged pictures and maps, with their own factors, masks, floors and means over pictures; their numbers do not compare with ours.",
    "leakage_*: the causes are the true diffuse shading (diffuse layer / true albedo) and the true specular layer, means of their reprojections from the training views into the texture.",
    "confidence: the solver's own confidence in a texel (confidence.exr), against the error of its diffuse albedo after the one factor, on coverage-e5. Other scores do not use it.",
    "diffuse_albedo_std: the standard deviations that the solver states (diffuse_albedo_std.exr), against the same error.",
    "mesh_*: the mesh's normal, the baseline for recovered normals. constant_specular_albedo: the best constant.",
];
