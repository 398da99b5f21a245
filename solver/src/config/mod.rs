//! Every number of the method, named, with its source; and the named configurations.

mod error;
mod known_mesh;
mod presets;
mod ranges;
mod renamed;
mod tables;

use serde::{Deserialize, Serialize};
use toml::{Table, Value};

pub use error::ConfigError;
pub use known_mesh::*;
use ranges::{not_negative, positive, range};
use renamed::refuse_renamed;
pub use tables::*;

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
    /// How skin reflects light at its surface.
    pub skin: SkinConfig,
    /// How much each pixel counts.
    pub view_weights: ViewWeightConfig,
    /// The initial textures.
    pub initialisation: InitialisationConfig,
    /// Regions of the face without labels.
    pub colour_regions: ColourRegionConfig,
    /// Hair that labels call skin.
    pub hair_in_skin: HairInSkinConfig,
    /// Networks and albedos together, at low resolution.
    pub warm_up: WarmUpConfig,
    /// Textures alone, at full resolution.
    pub fine_tuning: FineTuningConfig,
    /// The optimiser.
    pub adam: AdamConfig,
    /// From solved to physical albedos.
    pub normalisation: NormalisationConfig,
    /// Diffuse shading by ray casts instead of a network.
    pub transport: TransportConfig,
    /// Normals from one height texture.
    pub height: HeightConfig,
    /// Errors of the model, by which the refinement weighs pixels.
    pub model_error: ModelErrorConfig,
    /// How much regions mirror.
    pub reflectance: ReflectanceConfig,
    /// Records that are kept for the report.
    pub records: RecordConfig,
}

impl Config {
    /// A named configuration: `paper` (every published value), `paper-tuned` (its unpublished values and its
    /// rates chosen), `unshade` (the default), or `fast`.
    pub fn preset(name: &str) -> Result<Self, ConfigError> {
        match name {
            "paper" => Ok(Self::paper()),
            "paper-tuned" => Ok(Self::paper_tuned()),
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
        refuse_renamed(&given)?;
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
        positive(&[
            ("networks.position_scale", n.position_scale),
            ("networks.normal_scale", n.normal_scale),
            ("networks.reflection_scale", n.reflection_scale),
            ("initialisation.specular_maximum", self.initialisation.specular_maximum),
            ("fine_tuning.deviation_range", f.deviation_range),
            ("normalisation.specular_maximum", self.normalisation.specular_maximum),
            ("adam.epsilon", self.adam.epsilon),
            ("view_weights.edge_slope", self.view_weights.edge_slope),
        ])?;
        not_negative(&[
            ("rendering.exposure", self.rendering.exposure),
            ("view_weights.depth_blur", self.view_weights.depth_blur),
            ("view_weights.slope_falloff", self.view_weights.slope_falloff),
            ("warm_up.prior", w.prior),
            ("warm_up.network_rate", w.network_rate),
            ("warm_up.diffuse_rate", w.diffuse_rate),
            ("warm_up.specular_rate", w.specular_rate),
            ("fine_tuning.prior", f.prior),
            ("fine_tuning.diffuse_rate", f.diffuse_rate),
            ("fine_tuning.specular_rate", f.specular_rate),
            ("fine_tuning.deviation_rate", f.deviation_rate),
            ("normalisation.specular_skin", self.normalisation.specular_skin),
            ("normalisation.specular_pooling", self.normalisation.specular_pooling),
        ])?;
        let fraction = |x: f32| (0.0..1.0).contains(&x);
        let narrow = |x: f32| (0.0..=0.1).contains(&x);
        range("fine_tuning.deviation_smoothing", f.deviation_smoothing, narrow, "0 to 0.1")?;
        range("fine_tuning.deviation_extent", f.deviation_extent, narrow, "0 to 0.1")?;
        range("fine_tuning.deviation_blur", f.deviation_blur, narrow, "0 to 0.1")?;
        range("adam.final_decay", self.adam.final_decay, |x| x > 0.0 && x <= 1.0, "above 0, to 1")?;
        range("adam.beta1", self.adam.beta1, fraction, "at least 0 and below 1")?;
        range("adam.beta2", self.adam.beta2, fraction, "at least 0 and below 1")?;
        let side = |x: usize| (16..=8192).contains(&x);
        range("warm_up.texture_size", w.texture_size, side, "16 to 8192")?;
        if let TextureSize::Side(texels) = f.texture_size {
            range("fine_tuning.texture_size", texels, side, "16 to 8192, or \"auto\"")?;
        }
        self.skin.validate()?;
        self.colour_regions.validate()?;
        self.hair_in_skin.validate()?;
        self.transport.validate()?;
        self.model_error.validate()?;
        self.reflectance.validate()?;
        self.height.validate()?;
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
        for name in ["paper", "paper-tuned", "unshade", "fast"] {
            let config = Config::preset(name).unwrap();
            assert_eq!(Config::from_toml(&config.to_toml()).unwrap(), config, "{name}");
        }
    }

    #[test]
    fn renamed_keys_are_refused_with_a_name_that_is_known() {
        let known = Table::try_from(Config::default()).unwrap();
        for (old, new) in renamed::RENAMED {
            let line = |key: &str| match key.split_once('.') {
                Some((table, key)) => format!("[{table}]\n{key} = 1"),
                None => format!("[{key}]"),
            };
            let message = Config::from_toml(&line(old)).unwrap_err().to_string();
            assert!(
                message.contains(old) && message.contains(&format!("write {new}")),
                "{message}"
            );
            let mut steps = new.split('.');
            let table = known.get(steps.next().unwrap()).unwrap();
            assert!(steps.next().is_none_or(|key| table.get(key).is_some()), "{new}");
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
