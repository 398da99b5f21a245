//! The tables of a configuration.

use serde::{Deserialize, Serialize};

/// Section 5.3, "Tiny MLPs": spatial light, diffuse kernel and specular kernel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NetworkConfig {
    /// Neurons per hidden layer, a multiple of 4; 16.
    pub width: usize,
    /// Hidden layers; 2.
    pub hidden_layers: usize,
    /// Length of the latent vectors that are multiplied, a multiple of 4; 8.
    pub outputs: usize,
    /// Positions span -1 to 1 along the mesh's longest side, times this. Not published.
    pub position_scale: f32,
    /// Factor on the unit normal before the diffuse kernel; 1.
    pub normal_scale: f32,
    /// Factor on the unit reflected direction before the specular kernel; 1.
    pub reflection_scale: f32,
}

/// Section 4.2.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RenderingConfig {
    /// Multiply the specular shading by Schlick's factor, equation (1).
    pub fresnel: bool,
    /// Reflectance at normal incidence in that factor; 0.04.
    pub f0: f32,
    /// Keep both albedos at or above zero after every step; the paper leaves them free.
    pub positive_albedo: bool,
    /// Mean luminance of the mesh that the training pictures are brought to before anything is solved, and
    /// back from in the end, so that no rate or weight depends on a capture's exposure. 0 takes them as they
    /// are, as in the paper.
    pub exposure: f32,
}

/// Section 5.3: cosine x inverse blurred depth derivative, scaled to mean 1 over all pixels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewWeightConfig {
    /// Divide the cosine by the blurred depth derivative, see [`capture::gbuffer::view_weights`].
    pub depth: bool,
    /// Standard deviation of the blur, pixels of the full picture. Not published.
    pub depth_blur: f32,
}

/// Section 5.3, first paragraph.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InitialisationConfig {
    /// One colour per label region; otherwise one colour for the whole face.
    pub semantic: bool,
    /// Names of labels that all begin with the colour of the largest of them: the shadow of an ear is
    /// no colour of skin. Without names in the capture, every label has its own colour. Empty in the
    /// paper.
    pub skin_labels: Vec<String>,
    /// Regions of like colour that take the place of labels in a capture without any; 0: none do.
    pub colour_regions: usize,
    /// The brightest initial specular albedo; 0.05.
    pub specular_maximum: f32,
    /// Seeds of the networks that are tried, from `seed` on; the warm-up goes on with the one that has
    /// the lowest loss. 1, as in the paper, tries none.
    pub starts: usize,
    /// Steps of the warm-up that each of them is given; those of the best count.
    pub start_iterations: usize,
}

/// Section 4.3.1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WarmUpConfig {
    /// Full-batch steps; 2000.
    pub iterations: usize,
    /// Side of the textures, texels; 128.
    pub texture_size: usize,
    /// Work on pictures averaged over 2 x 2 pixels; true.
    pub half_resolution: bool,
    /// Weight of the albedo prior, equation (2). The paper does not give it.
    pub prior: f32,
    /// Learning rate of the networks; 0.001.
    pub network_rate: f32,
    /// Learning rate of the diffuse albedo; 0.001.
    pub diffuse_rate: f32,
    /// Learning rate of the specular albedo; 0.001.
    pub specular_rate: f32,
}

/// Section 4.3.2.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FineTuningConfig {
    /// How often the two stages are repeated; 2.
    pub rounds: usize,
    /// Full-batch steps per stage; 250.
    pub iterations: usize,
    /// Side of the textures; 2048, or "auto": the power of two nearest to one texel per pixel
    /// of the training views, from 128 to 2048; maps are then written with 512 texels or more, since
    /// coarser ones lose the mesh normal.
    pub texture_size: TextureSize,
    /// Weight of the albedo prior in the diffuse stages; the paper has it in the warm-up only.
    pub prior: f32,
    /// Largest component of the deviation from the mesh normal; 0.5.
    pub deviation_range: f32,
    /// Standard deviation of the blur from the optimised texture to the specular deviation, as a
    /// fraction of the texture's side; the paper has none, so 0.
    pub deviation_smoothing: f32,
    /// Standard deviation of a second, wider blur that is subtracted, as a fraction of the texture's
    /// side: relief coarser than this is left to the mesh. 0 subtracts nothing, as in the paper.
    pub deviation_extent: f32,
    /// Standard deviation of the blur between specular and diffuse deviation, as a fraction of the
    /// texture's side. Not published.
    pub deviation_blur: f32,
    /// Learning rate of the diffuse albedo; 0.001.
    pub diffuse_rate: f32,
    /// Learning rate of the specular albedo; 0.001.
    pub specular_rate: f32,
    /// Learning rate of the deviation, before the tanh; 0.001.
    pub deviation_rate: f32,
}

/// Side of the fine-tuned textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number of texels or \"auto\"")]
pub enum TextureSize {
    /// Texels.
    Side(usize),
    /// From the number of pixels.
    Rule(TextureRule),
}

/// How to choose the side of the fine-tuned textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TextureRule {
    /// The power of two nearest to one texel per pixel.
    Auto,
}

/// The side of the fine-tuned textures for training views of so many pixels.
pub(crate) fn texture_size(size: TextureSize, pixels: usize) -> usize {
    match size {
        TextureSize::Side(texels) => texels,
        TextureSize::Rule(TextureRule::Auto) => {
            let exponent = (pixels.max(1) as f64).sqrt().log2().round() as u32;
            2usize.pow(exponent.clamp(7, 11))
        }
    }
}

/// The side of the maps. From few pixels they are larger than what was solved, for the sake of the mesh
/// normal in them.
pub(crate) fn map_size(size: TextureSize, solved: usize) -> usize {
    match size {
        TextureSize::Side(texels) => texels,
        TextureSize::Rule(TextureRule::Auto) => solved.max(512),
    }
}

/// Kingma and Ba's optimiser with the defaults of the framework that the paper uses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdamConfig {
    /// Decay of the first moment; 0.9.
    pub beta1: f32,
    /// Decay of the second moment; 0.999.
    pub beta2: f32,
    /// Added to the root of the second moment; 1e-8.
    pub epsilon: f32,
    /// Share of the learning rates at the end of a stage, reached geometrically over its last 40 %;
    /// the paper keeps them constant.
    pub final_share: f32,
}

/// Section 5.4. Pictures are exposed so that the largest irradiance is pi: then a Lambert
/// reflectance is the solved albedo times the largest diffuse shading.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NormalisationConfig {
    /// Percentile of the diffuse shading that counts as its largest; 100 is the paper's maximum.
    pub diffuse_percentile: f64,
    /// Percentile of the specular albedo that becomes `specular_maximum`; 100 is the paper's.
    pub specular_percentile: f64,
    /// Upper end of human skin's reflectance at normal incidence; 0.05.
    pub specular_maximum: f32,
    /// Mean specular albedo of the largest region, which is skin; it then replaces `specular_percentile`
    /// and `specular_maximum`. 0.028 is that of an index of refraction of 1.4. 0 in the paper.
    pub specular_skin: f32,
    /// Pool the specular albedo: over each region, or where the face is one over this distance,
    /// metres (standard deviation), since within a region pictures tell next to nothing of it. 0 leaves
    /// it as solved, as in the paper.
    pub specular_pooling: f32,
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
    /// The albedo that light bounces off while the light is sought; then it is the face's own.
    pub bounce_albedo: f32,
    /// Steps that seek the light and its distance alone, the albedo held, on an even sky.
    pub probe: usize,
    /// Learning rate of the light's nearness (inverse distance, in units of about 1 per metre around a
    /// head); 0 leaves the light at infinity.
    pub nearness_rate: f32,
    /// Full-batch steps of light and albedo together.
    pub iterations: usize,
    /// Give regions that are no skin a colour anew under the light of the probe; needs
    /// [`InitialisationConfig::skin_labels`].
    pub recolour: bool,
    /// After [`Self::distance`], which it needs, give the light the colour of its highlights, and the
    /// diffuse albedo what is left.
    pub tint: bool,
    /// Steps before the diffuse albedo moves: first the light settles on the semantic colours.
    pub hold: usize,
    /// Weight of the albedo prior.
    pub prior: f32,
    /// Weight of the squared deviation of the mean shading from grey.
    pub grey_mean: f32,
    /// Weight of the mean absolute deviation of each texel's shading from grey.
    pub grey_texel: f32,
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
    pub veil: bool,
    /// Steps after the probe that seek the light and its distance once more, the albedo held, with the
    /// highlights that the light itself makes on skin; need what `veil` needs. 0 leaves both as the probe
    /// has found them, with the networks' highlights.
    pub distance: usize,
    /// Steps of light and albedo together with such highlights, in the end. 0 leaves highlights to the
    /// networks; then little of the veil is taken out where the light has contrast.
    pub highlights: usize,
    /// Steps that refine the albedo on the final texture and full pictures.
    pub refinement: usize,
    /// Weight of the albedo prior in the refinement.
    pub refinement_prior: f32,
}

/// How much regions mirror, by their highlights; not in the paper. Needs regions and
/// [`TransportConfig::distance`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReflectanceConfig {
    /// Rounds of [`TransportConfig::distance`], with the reflectances measured after each. 0 leaves them at
    /// [`NormalisationConfig::specular_skin`].
    pub rounds: usize,
    /// Power of skin's slope that counts: the light was found by skin's highlights and has bent halfway to a
    /// reflectance that was wrong, so that a slope shows about half of what is wrong in it.
    pub relaxation: f32,
    /// Standard deviation of skin's reflectance among people, relative.
    pub skin_deviation: f32,
    /// Standard deviation of another region's around that of skin, relative.
    pub region_deviation: f32,
    /// Standard error of every measurement, relative: of the light and the normals that it goes by.
    pub model_error: f32,
    /// Which power of skin's factor over the expected is the exposure's, and not skin's.
    pub exposure_share: f32,
}

/// Normals by Gauss-Newton on a height texture; not in the paper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeightConfig {
    /// Solve for heights; false leaves normals to the deviation texture, as in the paper.
    pub enabled: bool,
    /// Side of the height texture over that of the fine-tuned textures.
    pub texture_share: f32,
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
    /// Residuals below this radiance count squared.
    pub residual_floor: f32,
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
    /// Weight of its squared differences from texel to texel.
    pub smoothness: f32,
    /// Weight of squared relative changes of the diffuse albedo.
    pub albedo_damping: f32,
}

/// The side of the texture on which [`HeightConfig::steps`] are taken.
const SIDE_OF_STEPS: usize = 256;

impl HeightConfig {
    /// Conjugate-gradient steps per reweighting on a texture of this side.
    pub(crate) fn steps_on(&self, side: usize) -> usize {
        (self.steps * side).div_ceil(SIDE_OF_STEPS)
    }
}

/// What a maps folder holds besides the maps, for whoever wants to see how they came about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordConfig {
    /// `stages/`: the maps after every stage, small.
    pub stages: bool,
    /// `layers/`: every training view as the model sees it.
    pub layers: bool,
}

/// Of more samples than this, the highlights are followed on a part: a cell of the sky and a texel of the
/// transport are far coarser than pixels.
pub(crate) const MOST_HIGHLIGHT_SAMPLES: usize = 40_000;
