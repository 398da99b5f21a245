//! Every number of the method, named, with its source; and the named configurations.

use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use crate::error::ConfigError;

/// How a capture is decomposed. Section numbers are those of the paper (Neural Shading Fields).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Seeds the networks' initial weights.
    pub seed: u64,
    /// The three shading networks.
    pub networks: NetworkConfig,
    /// The pixel model.
    pub rendering: RenderingConfig,
    /// How much each pixel counts.
    pub view_weights: ViewWeightConfig,
    /// What the textures start from.
    pub initialisation: InitialisationConfig,
    /// Networks and albedos together, at low resolution.
    pub warm_up: WarmUpConfig,
    /// Textures alone, at full resolution.
    pub fine_tuning: FineTuningConfig,
    /// The optimiser.
    pub adam: AdamConfig,
    /// From solved to physical albedos.
    pub normalisation: NormalisationConfig,
}

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
}

/// Section 5.3: cosine x inverse blurred depth derivative, scaled to mean 1 over all pixels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewWeightConfig {
    /// Divide the cosine by the blurred depth derivative, see [`crate::gbuffer::view_weights`].
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
    /// The brightest initial specular albedo; 0.05.
    pub specular_maximum: f32,
    /// Seeds of the networks that are tried, from `seed` on; the one with the lowest loss is
    /// taken. 1, as in the paper, tries none.
    pub starts: usize,
    /// Steps of the warm-up that each of them is given.
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
}

impl Config {
    /// A named configuration: `paper` (every published value), `unshade` (the default), or `fast`.
    pub fn preset(name: &str) -> Result<Self, ConfigError> {
        match name {
            "paper" => Ok(Self::paper()),
            "unshade" => Ok(Self::unshade()),
            "fast" => Ok(Self::fast()),
            other => Err(ConfigError::UnknownPreset(other.to_owned())),
        }
    }

    /// Reads a configuration. `base = "paper"` names the configuration (default `unshade`) whose
    /// values hold where the text is silent. Unknown keys are errors.
    pub fn from_toml(text: &str) -> Result<Self, ConfigError> {
        let toml_error = |error: &dyn std::fmt::Display| {
            let message = error.to_string();
            let lines: Vec<&str> =
                message.lines().map(str::trim).filter(|l| !l.is_empty()).collect();
            ConfigError::Toml(lines.join(" "))
        };
        let mut given: Table = toml::from_str(text).map_err(|error| toml_error(&error))?;
        let base = match given.remove("base") {
            None => Self::unshade(),
            Some(Value::String(name)) => Self::preset(&name)?,
            Some(other) => {
                return Err(ConfigError::Toml(format!("base is {other}, expected a name")));
            }
        };
        let mut merged = Table::try_from(&base).map_err(|error| toml_error(&error))?;
        overlay(&mut merged, given);
        let config: Self = merged.try_into().map_err(|error| toml_error(&error))?;
        config.validate()?;
        Ok(config)
    }

    /// The whole configuration as TOML that [`Config::from_toml`] reads back.
    pub fn to_toml(&self) -> String {
        // Serialising plain numbers, booleans and strings below string keys cannot fail.
        toml::to_string(self).unwrap_or_default()
    }

    /// Checks every value against its range.
    pub fn validate(&self) -> Result<(), ConfigError> {
        let (n, w, f) = (&self.networks, &self.warm_up, &self.fine_tuning);
        let blocks_of_four = |x: usize| x > 0 && x <= 64 && x.is_multiple_of(4);
        range("networks.width", n.width, blocks_of_four, "a multiple of 4 up to 64")?;
        range("networks.outputs", n.outputs, blocks_of_four, "a multiple of 4 up to 64")?;
        range("networks.hidden_layers", n.hidden_layers, |x| (1..=8).contains(&x), "1 to 8")?;
        for (key, value) in [
            ("networks.position_scale", n.position_scale),
            ("networks.normal_scale", n.normal_scale),
            ("networks.reflection_scale", n.reflection_scale),
            ("initialisation.specular_maximum", self.initialisation.specular_maximum),
            ("fine_tuning.deviation_range", f.deviation_range),
            ("normalisation.specular_maximum", self.normalisation.specular_maximum),
            ("adam.epsilon", self.adam.epsilon),
        ] {
            range(key, value, |x| x > 0.0 && x.is_finite(), "positive")?;
        }
        for (key, value) in [
            ("view_weights.depth_blur", self.view_weights.depth_blur),
            ("warm_up.prior", w.prior),
            ("warm_up.network_rate", w.network_rate),
            ("warm_up.diffuse_rate", w.diffuse_rate),
            ("warm_up.specular_rate", w.specular_rate),
            ("fine_tuning.prior", f.prior),
            ("fine_tuning.diffuse_rate", f.diffuse_rate),
            ("fine_tuning.specular_rate", f.specular_rate),
            ("fine_tuning.deviation_rate", f.deviation_rate),
        ] {
            range(key, value, |x| x >= 0.0 && x.is_finite(), "zero or positive")?;
        }
        let fraction = |x: f32| (0.0..1.0).contains(&x);
        let narrow = |x: f32| (0.0..=0.1).contains(&x);
        range("fine_tuning.deviation_smoothing", f.deviation_smoothing, narrow, "0 to 0.1")?;
        range("fine_tuning.deviation_extent", f.deviation_extent, narrow, "0 to 0.1")?;
        range("fine_tuning.deviation_blur", f.deviation_blur, narrow, "0 to 0.1")?;
        range("rendering.f0", self.rendering.f0, fraction, "0 to 1")?;
        range("adam.final_share", self.adam.final_share, |x| x > 0.0 && x <= 1.0, "above 0, to 1")?;
        range("adam.beta1", self.adam.beta1, fraction, "at least 0 and below 1")?;
        range("adam.beta2", self.adam.beta2, fraction, "at least 0 and below 1")?;
        let side = |x: usize| (16..=8192).contains(&x);
        range("warm_up.texture_size", w.texture_size, side, "16 to 8192")?;
        if let TextureSize::Side(texels) = f.texture_size {
            range("fine_tuning.texture_size", texels, side, "16 to 8192, or \"auto\"")?;
        }
        let percent = |x: f64| x > 0.0 && x <= 100.0;
        let normalisation = &self.normalisation;
        range(
            "normalisation.diffuse_percentile",
            normalisation.diffuse_percentile,
            percent,
            "above 0, to 100",
        )?;
        range(
            "normalisation.specular_percentile",
            normalisation.specular_percentile,
            percent,
            "above 0, to 100",
        )
    }

    /// Every value the paper's; what it does not publish is said above, value by value.
    fn paper() -> Self {
        Self {
            seed: 0,
            networks: NetworkConfig {
                width: 16,
                hidden_layers: 2,
                outputs: 8,
                position_scale: 1.0,
                normal_scale: 1.0,
                reflection_scale: 1.0,
            },
            rendering: RenderingConfig { fresnel: true, f0: 0.04, positive_albedo: false },
            view_weights: ViewWeightConfig { depth: true, depth_blur: 2.0 },
            initialisation: InitialisationConfig {
                semantic: true,
                specular_maximum: 0.05,
                starts: 1,
                start_iterations: 500,
            },
            warm_up: WarmUpConfig {
                iterations: 2000,
                texture_size: 128,
                half_resolution: true,
                prior: 0.3,
                network_rate: 1e-3,
                diffuse_rate: 1e-3,
                specular_rate: 1e-3,
            },
            fine_tuning: FineTuningConfig {
                rounds: 2,
                iterations: 250,
                texture_size: TextureSize::Side(2048),
                prior: 0.0,
                deviation_range: 0.5,
                deviation_smoothing: 0.0,
                deviation_extent: 0.0,
                deviation_blur: 0.004,
                diffuse_rate: 1e-3,
                specular_rate: 1e-3,
                deviation_rate: 1e-3,
            },
            adam: AdamConfig { beta1: 0.9, beta2: 0.999, epsilon: 1e-8, final_share: 1.0 },
            normalisation: NormalisationConfig {
                diffuse_percentile: 100.0,
                specular_percentile: 100.0,
                specular_maximum: 0.05,
            },
        }
    }

    /// The paper's model with a rate of its own for every quantity, the prior kept in the
    /// fine-tuning, and sturdier normalisation.
    fn unshade() -> Self {
        let mut config = Self::paper();
        config.view_weights.depth = false;
        config.networks.normal_scale = 2.0;
        config.networks.reflection_scale = 3.0;
        config.rendering.positive_albedo = true;
        // Some weights never learn the highlights, and the loss shows it early.
        config.initialisation.starts = 4;
        config.warm_up.network_rate = 5e-3;
        config.warm_up.diffuse_rate = 3e-4;
        config.warm_up.specular_rate = 5e-5;
        config.fine_tuning.texture_size = TextureSize::Rule(TextureRule::Auto);
        config.fine_tuning.prior = 0.3;
        config.fine_tuning.deviation_smoothing = 0.002;
        config.fine_tuning.deviation_extent = 0.008;
        config.fine_tuning.specular_rate = 1e-5;
        config.fine_tuning.deviation_rate = 2e-5;
        config.normalisation.diffuse_percentile = 99.9;
        config.normalisation.specular_percentile = 99.0;
        config
    }

    /// `unshade` with fewer iterations and texels.
    fn fast() -> Self {
        let mut config = Self::unshade();
        config.initialisation.start_iterations = 150;
        config.warm_up.iterations = 500;
        config.fine_tuning.rounds = 1;
        config.fine_tuning.iterations = 100;
        config.fine_tuning.texture_size = TextureSize::Side(256);
        config
    }
}

impl Default for Config {
    fn default() -> Self {
        Self::unshade()
    }
}

/// Replaces what `above` names; tables are merged, everything else is replaced.
fn overlay(below: &mut Table, above: Table) {
    for (key, value) in above {
        match (below.get_mut(&key), value) {
            (Some(Value::Table(old)), Value::Table(new)) => overlay(old, new),
            // A rate written as `1` is as good as `1.0`.
            (Some(old @ Value::Float(_)), Value::Integer(number)) => {
                *old = Value::Float(number as f64)
            }
            (_, value) => {
                below.insert(key, value);
            }
        }
    }
}

fn range<T: ToString + Copy>(
    key: &'static str,
    value: T,
    allowed: impl Fn(T) -> bool,
    range: &'static str,
) -> Result<(), ConfigError> {
    if allowed(value) {
        Ok(())
    } else {
        Err(ConfigError::Range { key, value: value.to_string(), range })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_overrides_single_values_of_its_base() {
        let text = "base = \"paper\"\nseed = 3\n[fine_tuning]\ntexture_size = 256\nprior = 1\n";
        let config = Config::from_toml(text).unwrap();
        let mut expected = Config::preset("paper").unwrap();
        expected.seed = 3;
        expected.fine_tuning.texture_size = TextureSize::Side(256);
        expected.fine_tuning.prior = 1.0;
        assert_eq!(config, expected);
        assert_eq!(Config::from_toml("").unwrap(), Config::default());
    }

    #[test]
    fn every_preset_is_valid_and_survives_the_round_trip() {
        for name in ["paper", "unshade", "fast"] {
            let config = Config::preset(name).unwrap();
            assert_eq!(Config::from_toml(&config.to_toml()).unwrap(), config, "{name}");
        }
    }

    #[test]
    fn mistakes_are_named() {
        let message = |text: &str| Config::from_toml(text).unwrap_err().to_string();
        assert!(message("[warm_up]\niteration = 3").contains("iteration"));
        assert!(message("[warm_up]\niterations = 1.5").contains("iterations"));
        assert!(message("base = \"papper\"").contains("papper"));
        assert!(message("[fine_tuning]\ntexture_size = \"big\"").contains("auto"));
        assert!(
            message("[networks]\nwidth = 10")
                .contains("networks.width is 10, but must be a multiple of 4")
        );
        assert!(message("[adam]\nbeta1 = 1.0").contains("adam.beta1"));
        assert!(!message("x = [").contains('\n'));
    }
}
