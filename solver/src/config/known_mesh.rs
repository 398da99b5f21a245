//! The tables of what a known mesh allows and the paper leaves unused: regions by colour, explicit transport,
//! heights.

use serde::{Deserialize, Serialize};

/// Regions of like reflectance that take the place of labels in a capture without any, and part what labels call
/// skin (with [`HairInSkinConfig::enabled`]); not in the paper. All values were found on rendered faces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColourRegionConfig {
    /// At most so many; 0: none are sought.
    pub count: usize,
    /// Side of the chart on which they are found, texels.
    pub texture_size: usize,
    /// Rows of the environment whose light is found on the way.
    pub rows: usize,
    /// Standard deviation of the blur that keeps noise out, texels.
    pub blur: f32,
    /// Weight of a difference in log luminance against one in the log ratios of the colours, which white light
    /// leaves alone: for the first clusters under cells, and for all others.
    pub luminance_weights: [f32; 2],
    /// Radiance below which ratios are noise, relative to the median luminance.
    pub dark: f32,
    /// Times that the light is found, and the regions under it.
    pub rounds: usize,
    /// Weighted least squares of the light in each, and after each joining of two parts.
    pub reweightings: usize,
    /// Multiplicative updates of the light under which hair is sought inside of skin, which a lamp has to beat, and
    /// whose shading regions by colour start from, too.
    pub light_steps: usize,
    /// Residuals of the shading below this count squared.
    pub residual_floor: f32,
    /// Shading, relative to the mean, below which the light says nothing of a colour.
    pub shading_floor: f32,
    /// Shading, relative to the mean, at which a texel's own colour counts as much as that of the largest region.
    pub shading_prior: f32,
    /// Distance over which a boundary is looked at, texels.
    pub edge_distance: usize,
    /// Smallest mean difference in the three log colours, as a vector, across the boundary of two connected parts.
    pub edge: f32,
    /// Pairs of texels without which a boundary says nothing, and texels without which a connected part is no
    /// region of its own.
    pub edge_pairs: usize,
}

/// Hair inside of what labels call skin; not in the paper. It is sought on the chart of [`ColourRegionConfig`], as
/// parts of another colour, and as a beard among parts that are too dark under a light of few unknowns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HairInSkinConfig {
    /// Seek it; false believes the labels.
    pub enabled: bool,
    /// Inverse distances of a lamp from the head's centre that are tried, per metre.
    pub lamp_nearness: [f32; 4],
    /// What a lamp shines on gets at least so much of its light, relative to skin in full light.
    pub lit: f32,
    /// Width of the lobes that the light of few unknowns is made of, radians.
    pub lobe_width: f32,
    /// Standard deviation of the blur before anything is called dark, texels.
    pub blur: f32,
    /// Log luminances below the median of skin from which on a texel is dark. All are tried, the one that leaves
    /// the least residual is kept.
    pub depths: [f32; 4],
    /// Texels of a part, relative to those of the skin, without which it is too small to tell.
    pub least_share: f32,
    /// A part is hair if its own colour, under a light of all unknowns, leaves at most so much of the residual: of
    /// all skin, and of the part.
    pub most_left: [f32; 2],
    /// And if its colour over skin's is at least so strong in blue, relative to red: shadows are redder.
    pub least_blue: f32,
    /// Weight of the last albedo's prior there, relative to skin's: strands on skin vary more than either.
    pub prior: f32,
}

/// Diffuse albedo under explicit shadowed transport of the known mesh; not in the paper. The light
/// is an RGB environment of `rows` x `2 rows` cells, positive by its exponential parametrisation,
/// and starts as 1 from everywhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TransportConfig {
    /// Take the diffuse albedo from this solve; false leaves it to the networks, as in the paper.
    pub enabled: bool,
    /// Side of the texture on which transport is computed, texels.
    pub texture_size: usize,
    /// Rows of the environment.
    pub rows: usize,
    /// Rays per cell are this number squared.
    pub rays_per_cell_side: usize,
    /// Bounces off the mesh.
    pub bounces: usize,
    /// A ray starts this far from the surface, as a fraction of the mesh's longest side: clear of the facets
    /// next to its own.
    pub ray_offset: f32,
    /// The albedo that light bounces off while the light is sought; then it is the face's own.
    pub bounce_albedo: f32,
    /// Steps that seek the light and its distance alone, the albedo held, on an even sky.
    pub probe: usize,
    /// Learning rate of the light's nearness (inverse distance, in units of about 1 per metre around a
    /// head); 0 leaves the light at infinity.
    pub nearness_rate: f32,
    /// The shading's change with the nearness is taken between a sphere of this radius and one at infinity, in
    /// halves of the mesh's longest side: about a metre around a head.
    pub near_radius: f32,
    /// No light is nearer than this, in the same unit.
    pub minimum_radius: f32,
    /// Full-batch steps of light and albedo together.
    pub iterations: usize,
    /// Give regions that are no skin a colour anew under the light of the probe; needs
    /// [`InitialisationConfig::skin_labels`].
    pub recolour: bool,
    /// After [`Self::distance`], which it needs, give the light the colour of its highlights, and the
    /// diffuse albedo what is left.
    pub tint: bool,
    /// The colour of highlights is not believed if channels differ by a larger factor than this,
    pub tint_range: f64,
    /// nor if the standard error of a channel's factor, relative to it, is larger than this.
    pub tint_error: f64,
    /// Steps before the diffuse albedo moves: first the light settles on the semantic colours.
    pub albedo_frozen_steps: usize,
    /// Weight of the albedo prior.
    pub prior: f32,
    /// Weight of the squared deviation of the mean shading from grey.
    pub grey_mean: f32,
    /// Weight of the mean absolute deviation of each texel's shading from grey.
    pub grey_texel: f32,
    /// Weight of neighbouring cells of the light whose colours differ: R, G, B of their logarithms, less the mean.
    pub light_colour: f32,
    /// Difference of a channel, in the logarithm, below which that costs next to nothing.
    pub light_colour_softness: f32,
    /// Learning rate of the light's logarithm.
    pub light_rate: f32,
    /// Learning rate of the diffuse albedo.
    pub diffuse_rate: f32,
    /// Learning rate of the specular albedo.
    pub specular_rate: f32,
    /// Learning rate of the networks, which here stand for the specular layer alone.
    pub network_rate: f32,
    /// Predict from the found light what all views share of the highlights, and take it out of the
    /// diffuse albedo; needs regions and [`NormalisationConfig::specular_skin`].
    pub specular_floor: bool,
    /// Standard deviation of the blur of what is taken out, texels.
    pub specular_floor_blur: f32,
    /// A light of this contrast is half even. The evener the light that was found without its highlights, the
    /// more of what it predicts of them is taken out, and the less its shading says of the normals.
    pub even_contrast: f32,
    /// Steps after the probe that seek the light and its distance once more, the albedo held, with the
    /// highlights that the light itself makes on skin, as far as they explain what they have not seen; needs what
    /// `specular_floor` needs. 0 leaves both as the probe has found them, with the networks' highlights.
    pub distance: usize,
    /// Learning rate of the light's logarithm meanwhile.
    pub distance_rate: f32,
    /// Steps of light and albedo together with such highlights, in the end. 0 leaves highlights to the
    /// networks; then little of the specular floor is taken out where the light has contrast.
    pub highlights: usize,
    /// Of more samples than this, such highlights are followed on a part: a cell of the sky and a texel of the
    /// transport are far coarser than pixels.
    pub highlight_samples: usize,
    /// Exponent of the cosine lobe that they see the light through: 10 degrees, about a cell. Finer than that, the
    /// cells do not tell of the light.
    pub light_exponent: i32,
    /// Steps that refine the albedo on the final texture and full pictures.
    pub refinement: usize,
    /// Texels around, standard deviation, by which hair, brows and lips begin it where pictures say little; 0: as
    /// they came.
    pub refinement_reach: f32,
    /// Weight of the albedo prior in the refinement.
    pub refinement_prior: f32,
    /// Learning rate of the albedo in the refinement.
    pub refinement_rate: f32,
    /// Residual, relative to the colour, at which the confidence in a texel's albedo has fallen to 1 / e.
    pub confidence_misfit: f32,
    /// Standard deviation of the blur of what confidence goes by, texels.
    pub confidence_blur: f32,
}

/// Standard deviations of the model's errors in a pixel under a known light, by which the refinement of the albedo
/// and the reflectance of regions weigh pixels; not in the paper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelErrorConfig {
    /// Of the diffuse shading, relative.
    pub shading: f32,
    /// Of the normals, radians: relief that the mesh does not have moves the shading most where light grazes.
    pub normal: f32,
    /// Of the highlights, relative.
    pub highlights: f32,
    /// Of the diffuse shading, over its mean: what bounces and penumbras bring where there is no light. 0 weighs all
    /// pixels alike.
    pub shadow: f32,
    /// Of the diffuse shading, over its mean, in place of `shadow` in the refinement: times how far the lights that
    /// either half of the face shows are apart in the shading that they make, at least `shading`; 0 leaves `shadow`,
    /// which remains the error at which the prior has the weight that it is given.
    pub doubt: f32,
    /// Diffuse albedo that counts as the least where errors or highlights are compared with it.
    pub darkest_albedo: f32,
}

/// Normals by Gauss-Newton on a height texture; not in the paper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeightConfig {
    /// Solve for heights; false leaves normals to the deviation texture, as in the paper.
    pub enabled: bool,
    /// Side of the height texture over that of the fine-tuned textures.
    pub texture_scale: f32,
    /// How often the pictures are linearised, each time on a texture of twice the side.
    pub linearisations: usize,
    /// Take highlights, and how they change with the normals, from the light that was found with its
    /// highlights ([`TransportConfig::highlights`]); else, or without such a light, from the networks.
    pub highlights: bool,
    /// Reweightings towards an L1 norm per linearisation.
    pub reweightings: usize,
    /// Conjugate-gradient steps per reweighting on a texture of side 256, and in proportion to the side on
    /// others: a step carries what it finds by a texel.
    pub steps: usize,
    /// Squared norm of the rest, over that of the goal, at which a solve has converged.
    pub tolerance: f64,
    /// Residuals below this radiance count squared.
    pub residual_floor: f32,
    /// How much skin's relief usually turns normals away from the mesh's, radians. Residuals beyond what this
    /// and `usual_albedo_detail` explain are the model's own error, and count the less.
    pub usual_deviation: f32,
    /// How much the detail of skin's albedo usually amounts to, relative.
    pub usual_albedo_detail: f32,
    /// Standard deviation of the neighbourhood in which residuals are compared with that, pixels.
    pub neighbourhood: f32,
    /// Texels in which a unit step of the height would turn the normal by more than this have no height: the chart
    /// is squeezed there.
    pub steepest: f32,
    /// Darkest albedo that a logarithm is taken of.
    pub darkest_albedo: f32,
    /// Standard deviation of the blur that takes detail out of the albedo's logarithm, as a fraction
    /// of the texture's side: relief must not be in it already.
    pub albedo_smoothing: f32,
    /// Standard deviation of the blur between specular and diffuse deviation, as a fraction of the
    /// texture's side.
    pub blur: f32,
    /// Residuals coarser than this are no relief: a standard deviation, as a fraction of the side of a square
    /// as large as the mesh in the view. 0 keeps them.
    pub coarsest: f32,
    /// Pixels this close to where the mesh ends in a view tell nothing of relief: they see two surfaces.
    pub rim: usize,
    /// Share of a residual's part in the colour of the diffuse layer that counts for nothing: most of what
    /// the model gets wrong has that colour, relief in highlights that of the light.
    pub diffuse_doubt: f32,
    /// Weight of the squared deviation. Without [`Self::highlights`], under explicit transport, over the
    /// squared contrast of the light, and more where that is even.
    pub flatness: f32,
    /// The least that this squared contrast counts.
    pub minimum_contrast: f32,
    /// Weight of its squared differences from texel to texel.
    pub smoothness: f32,
    /// Weight of squared heights, which pulls those to zero that no pixel sees.
    pub unseen_damping: f32,
    /// Weight of squared relative changes of the diffuse albedo.
    pub albedo_damping: f32,
    /// Relief that the views of one side find is held against the highlights of the other side's. Where those
    /// show this share of it or less, none is believed; where they show all, all. 0 believes all.
    pub doubt: f32,
}

/// The side of the texture on which [`HeightConfig::steps`] are taken.
const SIDE_OF_STEPS: usize = 256;

impl HeightConfig {
    /// Conjugate-gradient steps per reweighting on a texture of this side.
    pub(crate) fn steps_on(&self, side: usize) -> usize {
        (self.steps * side).div_ceil(SIDE_OF_STEPS)
    }
}
