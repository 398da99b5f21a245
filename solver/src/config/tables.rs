//! The tables of a configuration.

use capture::Capture;
use capture::sampling::finest_sampling;
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
    /// Multiply the specular shading by Schlick's factor, equation (1), of [`SkinConfig::f0`].
    pub fresnel: bool,
    /// Keep both albedos at or above zero after every step; the paper leaves them free.
    pub positive_albedo: bool,
    /// Mean luminance of the mesh that the training pictures are brought to before anything is solved, and
    /// back from in the end, so that no rate or weight depends on a capture's exposure. 0 takes them as they
    /// are, as in the paper.
    pub exposure: f32,
    /// Other than 0, every value of the training pictures is multiplied with 1 + 1e-6 u, u from -1 to 1 drawn by
    /// this seed: as much as another processor or another order of a sum may change. What becomes of it is how
    /// far a change of the program that changes nothing moves the maps.
    pub rounding_seed: u64,
}

/// The specular reflection of skin. The renderer's material has the same numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SkinConfig {
    /// Reflectance at normal incidence in Schlick's factor, equation (1); 0.04.
    pub f0: f32,
    /// GGX alphas of two lobes: fits of skin need a narrow and a wide one (Ghosh et al. 2008); 0.15 and 0.35, after
    /// the shaders of Digital Emily 2. Not in the paper.
    pub roughness: [f32; 2],
    /// Their parts of the reflection; equal there.
    pub weights: [f32; 2],
}

impl SkinConfig {
    /// Roughness and weight of each lobe.
    pub(crate) fn lobes(&self) -> [(f32, f32); 2] {
        std::array::from_fn(|lobe| (self.roughness[lobe], self.weights[lobe]))
    }
}

/// Section 5.3: cosine x inverse blurred depth derivative, scaled to mean 1 over all pixels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewWeightConfig {
    /// Divide the cosine by the blurred depth derivative, see `view_weights.rs`.
    pub depth: bool,
    /// Standard deviation of the blur, pixels of the full picture. Not published.
    pub depth_blur: f32,
    /// The slope of a silhouette, and the largest one: the surface turned away by 84 degrees. Not published.
    pub edge_slope: f32,
    /// Inverse slope at which the weight is half of the cosine. Not published.
    pub slope_falloff: f32,
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
    /// Side of the textures; 2048, or "auto": the power of two nearest to two texels per pixel of the
    /// training view that sees a place finest, on average over the surface, from 128 to 2048; maps are
    /// then written with 512 texels or more, since coarser ones lose the mesh normal.
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
    /// From the pictures' sampling of the surface.
    Rule(TextureRule),
}

/// How to choose the side of the fine-tuned textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TextureRule {
    /// The power of two nearest to two texels per pixel of the finest view.
    Auto,
}

/// The side of the fine-tuned textures for the training views of a capture.
pub(crate) fn texture_size(size: TextureSize, capture: &Capture) -> usize {
    match size {
        TextureSize::Side(texels) => texels,
        TextureSize::Rule(TextureRule::Auto) => {
            automatic_side(finest_sampling(&capture.mesh, &capture.train))
        }
    }
}

/// The side that [`texture_size`] gives about, where only the number of views and of their covered pixels is known:
/// the finest view has some five times as many pixels per unit of the chart as a view covers on average.
pub fn expected_texture_size(config: &super::Config, views: usize, pixels: usize) -> usize {
    match config.fine_tuning.texture_size {
        TextureSize::Side(texels) => texels,
        TextureSize::Rule(TextureRule::Auto) => {
            automatic_side(5.0 * pixels as f64 / views.max(1) as f64)
        }
    }
}

/// The power of two nearest to two texels per pixel of the finest view, which has `sampling` pixels per unit of the
/// chart. Two: the pixel grids of views that see a place about as finely lie between one another.
fn automatic_side(sampling: f64) -> usize {
    let exponent = (2.0 * sampling).max(1.0).sqrt().log2().round() as u32;
    2usize.pow(exponent.clamp(7, 11))
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
    /// Factor on the learning rates at the end of a stage, reached geometrically over its last 40 %;
    /// the paper keeps them constant.
    pub final_decay: f32,
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

/// How much regions mirror, by their highlights; not in the paper. Needs regions and
/// [`TransportConfig::distance`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReflectanceConfig {
    /// Rounds of [`TransportConfig::distance`], with the reflectances measured after each. 0 leaves them at
    /// [`NormalisationConfig::specular_skin`].
    pub rounds: usize,
    /// Standard deviation of skin's reflectance among people, relative.
    pub skin_deviation: f32,
    /// Standard deviation of another region's around that of skin, relative.
    pub region_deviation: f32,
    /// Standard error of every measurement of skin, relative: of the light and the normals that it goes by.
    pub model_error: f32,
    /// That of other regions: the light was not found by their highlights.
    pub region_error: f32,
    /// And relative to skin's reflectance, whatever they seem to mirror: a light that is a little off predicts
    /// highlights where there are none, and then a region would mirror nothing, with certainty.
    pub region_floor: f32,
    /// Rounds in which the roughness is measured once the relief is found; 0 leaves the lobes of [`SkinConfig`].
    pub roughness_rounds: usize,
    /// Samples that it is measured by, about; more than that tell no more.
    pub roughness_samples: usize,
    /// Standard deviation of the logarithm of a region's roughness around that of skin, and of skin's around the
    /// usual one.
    pub roughness_deviation: f32,
    /// Exponent of the cosine lobe that the light is seen through meanwhile: next to none, since lamps are often
    /// smaller than the cells that stand for them, and skin then seems sharper than it is.
    pub roughness_light_exponent: i32,
    /// Standard error of the logarithm of every measured roughness: of the light, which is no sharper than its
    /// cells.
    pub roughness_error: f32,
    /// Standard deviation of the logarithm of a picture's exposure around what the light's peak says; 0 takes the
    /// peak's word.
    pub exposure_deviation: f32,
}

impl ReflectanceConfig {
    /// Rounds of [`TransportConfig::distance`], measured or not.
    pub(crate) fn rounds(&self) -> usize {
        self.rounds.max(1)
    }
}

/// Records in a maps folder besides the maps, for whoever wants to see how they came about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordConfig {
    /// `stages/`: the maps after every stage, small.
    pub stages: bool,
    /// `layers/`: every training view as the model sees it.
    pub layers: bool,
}
