//! The named configurations.

use super::*;

/// Skin as face parsers name it.
const SKIN: [&str; 7] = ["skin", "nose", "ear", "l_ear", "r_ear", "eyelid", "neck"];

impl Config {
    /// Every value the paper's; what it does not publish is said above, value by value.
    pub(super) fn paper() -> Self {
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
            rendering: RenderingConfig {
                fresnel: true,
                positive_albedo: false,
                exposure: 0.0,
                rounding_seed: 0,
            },
            skin: SkinConfig { f0: 0.04, roughness: [0.15, 0.35], weights: [0.5; 2] },
            view_weights: ViewWeightConfig {
                depth: true,
                depth_blur: 2.0,
                edge_slope: 10.0,
                slope_falloff: 1.0,
            },
            initialisation: InitialisationConfig {
                semantic: true,
                skin_labels: vec![],
                specular_maximum: 0.05,
                starts: 1,
                start_iterations: 500,
            },
            colour_regions: ColourRegionConfig {
                count: 0,
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
            },
            hair_in_skin: HairInSkinConfig {
                enabled: false,
                lamp_nearness: [0.4, 0.8, 1.2, 1.6],
                lit: 0.15,
                lobe_width: 0.7,
                blur: 2.0,
                depths: [0.2, 0.35, 0.5, 0.8],
                least_share: 0.02,
                most_left: [0.87, 0.85],
                least_blue: 0.85,
                prior: 0.33,
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
            adam: AdamConfig { beta1: 0.9, beta2: 0.999, epsilon: 1e-8, final_decay: 1.0 },
            normalisation: NormalisationConfig {
                diffuse_percentile: 100.0,
                specular_percentile: 100.0,
                specular_maximum: 0.05,
                specular_skin: 0.0,
                specular_pooling: 0.0,
            },
            transport: TransportConfig {
                enabled: false,
                texture_size: 128,
                rows: 16,
                rays_per_cell_side: 2,
                bounces: 2,
                ray_offset: 1.6e-3,
                bounce_albedo: 0.4,
                probe: 200,
                nearness_rate: 0.02,
                near_radius: 6.0,
                minimum_radius: 2.5,
                iterations: 400,
                recolour: true,
                tint: true,
                tint_range: 2.0,
                tint_error: 0.05,
                albedo_frozen_steps: 100,
                prior: 1.0,
                grey_mean: 1.0,
                grey_texel: 0.001,
                light_colour: 0.002,
                light_colour_softness: 0.3,
                light_rate: 5e-2,
                diffuse_rate: 3e-4,
                specular_rate: 2e-5,
                network_rate: 3e-3,
                specular_floor: true,
                specular_floor_blur: 1.5,
                even_contrast: 0.3,
                distance: 600,
                distance_rate: 0.2,
                highlights: 150,
                highlight_samples: 40_000,
                light_exponent: 64,
                refinement: 400,
                refinement_reach: 60.0,
                refinement_prior: 2.0,
                refinement_rate: 8e-4,
                confidence_misfit: 0.1,
                confidence_blur: 1.5,
            },
            model_error: ModelErrorConfig {
                shading: 0.05,
                normal: 0.07,
                highlights: 0.3,
                shadow: 0.3,
                doubt: 5.0,
                darkest_albedo: 0.02,
            },
            reflectance: ReflectanceConfig {
                rounds: 2,
                skin_deviation: 0.5,
                region_deviation: 0.5,
                model_error: 0.1,
                region_error: 0.3,
                region_floor: 0.15,
                roughness_rounds: 2,
                roughness_samples: 400_000,
                roughness_deviation: 0.5,
                roughness_error: 0.2,
                roughness_light_exponent: 512,
                exposure_deviation: 0.25,
            },
            height: HeightConfig {
                enabled: false,
                texture_scale: 0.5,
                linearisations: 2,
                highlights: false,
                reweightings: 2,
                steps: 60,
                tolerance: 1e-5,
                residual_floor: 0.002,
                usual_deviation: 0.05,
                usual_albedo_detail: 0.03,
                neighbourhood: 3.0,
                steepest: 6.0,
                darkest_albedo: 1e-3,
                albedo_smoothing: 0.003,
                blur: 0.003,
                coarsest: 0.075,
                rim: 2,
                diffuse_doubt: 0.6,
                flatness: 100.0,
                minimum_contrast: 1e-4,
                smoothness: 300.0,
                unseen_damping: 1e-3,
                albedo_damping: 300.0,
                doubt: 0.0,
            },
            records: RecordConfig { stages: true, layers: true },
        }
    }

    /// The paper's model with a rate of its own for every quantity, the prior kept in the
    /// fine-tuning, and sturdier normalisation.
    pub(crate) fn unshade() -> Self {
        let mut config = Self::paper();
        config.view_weights.depth = false;
        config.networks.normal_scale = 2.0;
        config.networks.reflection_scale = 3.0;
        config.rendering.positive_albedo = true;
        config.rendering.exposure = 0.13;
        // Some weights never learn the highlights, and the loss shows it early.
        config.initialisation.starts = 4;
        config.initialisation.skin_labels = SKIN.map(str::to_owned).to_vec();
        config.colour_regions.count = 4;
        config.hair_in_skin.enabled = true;
        config.initialisation.start_iterations = 400;
        config.warm_up.network_rate = 5e-3;
        config.warm_up.diffuse_rate = 3e-4;
        config.warm_up.specular_rate = 5e-5;
        config.fine_tuning.texture_size = TextureSize::Rule(TextureRule::Auto);
        config.fine_tuning.prior = 0.3;
        config.fine_tuning.deviation_smoothing = 0.002;
        config.fine_tuning.deviation_extent = 0.008;
        config.fine_tuning.specular_rate = 1e-5;
        config.fine_tuning.deviation_rate = 0.0;
        config.transport.enabled = true;
        config.height.enabled = true;
        config.height.highlights = true;
        config.height.doubt = 0.65;
        config.normalisation.diffuse_percentile = 99.9;
        config.normalisation.specular_percentile = 99.0;
        config.normalisation.specular_skin = 0.028;
        config.normalisation.specular_pooling = 0.013;
        config
    }

    /// The paper's method and model, with the values that it does not publish, and the rates, chosen on
    /// the four faces of the suite `method`: a rate of its own for every quantity, the prior kept in the fine-tuning, percentiles where a
    /// maximum rests on one texel, four starts, and textures of one texel a pixel. What the published rates cost
    /// is no part of the method.
    pub(super) fn paper_tuned() -> Self {
        let mut config = Self::paper();
        config.view_weights.depth = false;
        config.networks.normal_scale = 2.0;
        config.networks.reflection_scale = 2.0;
        config.rendering.positive_albedo = true;
        config.initialisation.starts = 4;
        config.warm_up.prior = 1.0;
        config.warm_up.network_rate = 3e-3;
        config.warm_up.diffuse_rate = 3e-4;
        config.warm_up.specular_rate = 2e-5;
        config.fine_tuning.texture_size = TextureSize::Rule(TextureRule::Auto);
        config.fine_tuning.prior = 1.0;
        config.fine_tuning.deviation_smoothing = 0.002;
        config.fine_tuning.diffuse_rate = 3e-4;
        config.fine_tuning.specular_rate = 2e-5;
        config.fine_tuning.deviation_rate = 3e-4;
        config.normalisation.diffuse_percentile = 99.9;
        config.normalisation.specular_percentile = 99.0;
        config
    }

    /// `unshade` with fewer iterations and texels, and no records.
    pub(super) fn fast() -> Self {
        let mut config = Self::unshade();
        config.initialisation.start_iterations = 150;
        config.warm_up.iterations = 500;
        config.fine_tuning.rounds = 1;
        config.fine_tuning.iterations = 100;
        config.fine_tuning.texture_size = TextureSize::Side(256);
        config.transport.texture_size = 64;
        config.transport.rows = 8;
        config.transport.probe = 100;
        config.transport.iterations = 200;
        config.transport.albedo_frozen_steps = 75;
        config.transport.distance = 200;
        config.transport.highlights = 75;
        config.transport.refinement = 50;
        config.height.linearisations = 1;
        config.height.steps = 40;
        config.records = RecordConfig { stages: false, layers: false };
        config
    }
}
