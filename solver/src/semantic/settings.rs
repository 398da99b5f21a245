//! The settings of the segmentation, tuned on rendered faces.

pub(super) use crate::config::TransportConfig;
use crate::config::UnshadeConfig;

/// All settings of the segmentation.
#[derive(Clone, Debug, Default)]
pub(super) struct Settings {
    pub colour_regions: ColourSettings,
    pub hair_in_skin: HairSettings,
    pub transport: TransportConfig,
}

impl Settings {
    pub fn new(config: &UnshadeConfig) -> Self {
        let texture_size = config.regions.texture_size;
        Self {
            colour_regions: ColourSettings { texture_size, ..ColourSettings::default() },
            hair_in_skin: HairSettings::default(),
            transport: config.transport.clone(),
        }
    }
}

/// Regions of similar reflectance, by colour.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ColourSettings {
    /// The largest number of regions.
    pub count: usize,
    /// Side of the chart of the segmentation, texels.
    pub texture_size: usize,
    /// Rows of the environment whose light is fitted.
    pub rows: usize,
    /// Standard deviation of the blur against noise, texels.
    pub blur: f32,
    /// Weight of a difference in log luminance, relative to one in the log ratios of the colours, which white light
    /// does not change: for the first clusters under cells, and for all others.
    pub luminance_weights: [f32; 2],
    /// Radiance below which ratios are noise, relative to the median luminance.
    pub dark: f32,
    /// Rounds of fitting the light and then the regions under it.
    pub rounds: usize,
    /// Reweightings of the least squares of the light in each round, and after each merge of two parts.
    pub reweightings: usize,
    /// Multiplicative updates of the light of few unknowns.
    pub light_steps: usize,
    /// Residuals of the shading below this are penalised by their squares.
    pub residual_floor: f32,
    /// Shading, relative to the mean, below which the light carries no information on a colour.
    pub shading_floor: f32,
    /// Shading, relative to the mean, at which a texel's own colour counts as much as that of the largest region.
    pub shading_prior: f32,
    /// Distance across a boundary over which colours are compared, texels.
    pub edge_distance: usize,
    /// Smallest mean difference in the three log colours, as a vector, across the boundary of two connected parts.
    pub edge: f32,
    /// Least number of pairs of texels of a tested boundary, and of texels of a region.
    pub edge_pairs: usize,
}

impl Default for ColourSettings {
    fn default() -> Self {
        Self {
            count: 4,
            texture_size: 128,
            rows: 8,
            blur: 0.7,
            luminance_weights: [0.1, 0.5],
            dark: 0.01,
            rounds: 10,
            reweightings: 3,
            light_steps: 30,
            residual_floor: 0.1,
            shading_floor: 0.02,
            shading_prior: 0.1,
            edge_distance: 3,
            edge: 0.55,
            edge_pairs: 25,
        }
    }
}

/// Hair in labelled skin.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct HairSettings {
    /// Candidate inverse distances of a lamp from the head's centre, per metre.
    pub lamp_nearness: [f32; 4],
    /// Least light of a texel that counts as lit by a lamp, relative to skin in full light.
    pub lit: f32,
    /// Width of the lobes of the light of few unknowns, radians.
    pub lobe_width: f32,
    /// Standard deviation of the blur before texels are classified as dark, texels.
    pub blur: f32,
    /// Candidate thresholds of dark texels, as log luminance below the median of skin. The one with the least residual
    /// is used.
    pub depths: [f32; 4],
    /// Texels of the smallest part, relative to those of the skin.
    pub least_share: f32,
    /// Largest share of the residual that remains if a part has its own colour under a light of free cells: of all
    /// skin, and of the part.
    pub most_left: [f32; 2],
    /// Least ratio of blue to red in a part's colour over that of skin: shadows are redder.
    pub least_blue: f32,
}

impl Default for HairSettings {
    fn default() -> Self {
        Self {
            lamp_nearness: [0.4, 0.8, 1.2, 1.6],
            lit: 0.15,
            lobe_width: 0.7,
            blur: 2.0,
            depths: [0.2, 0.35, 0.5, 0.8],
            least_share: 0.02,
            most_left: [0.87, 0.85],
            least_blue: 0.85,
        }
    }
}
