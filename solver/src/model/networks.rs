//! Parameters of the three shading networks (section 5.3, "Tiny MLPs").

use std::ops::Range;

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use crate::config::NetworkConfig;

/// One of the three networks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Network {
    /// Position to light vector; last activation exp.
    Light = 0,
    /// Diffuse normal to kernel vector; last activation softplus.
    Diffuse = 1,
    /// Reflected direction to kernel vector; last activation softplus.
    Specular = 2,
}

impl Network {
    /// The networks in the order of their parameters.
    pub const ALL: [Self; 3] = [Self::Light, Self::Diffuse, Self::Specular];
}

/// Weights and biases of three equal multilayer perceptrons with ReLU between their layers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Networks {
    /// Neurons per layer, the three inputs first: 3, 16, 16, 8.
    pub shape: Vec<usize>,
    /// Network by network, layer by layer: weights (one row of inputs per output), then biases.
    pub parameters: Vec<f32>,
}

impl Networks {
    /// Draws every weight and bias uniformly from +-1/sqrt(inputs), as PyTorch initialises linear layers.
    pub fn new(config: &NetworkConfig, seed: u64) -> Self {
        let mut shape = vec![3];
        shape.extend(vec![config.width; config.hidden_layers]);
        shape.push(config.outputs);
        let mut random = Pcg64::seed_from_u64(seed);
        let mut parameters = vec![];
        for _ in Network::ALL {
            for layer in shape.windows(2) {
                let bound = 1.0 / (layer[0] as f32).sqrt();
                let uniform = |_| {
                    let unit = (random.next_u32() >> 8) as f32 / (1 << 24) as f32;
                    bound * (2.0 * unit - 1.0)
                };
                parameters.extend((0..layer[0] * layer[1] + layer[1]).map(uniform));
            }
        }
        Self { shape, parameters }
    }

    /// Layers per network.
    pub fn layers(&self) -> usize {
        self.shape.len() - 1
    }

    /// Length of the vectors that are multiplied.
    pub fn outputs(&self) -> usize {
        self.shape[self.layers()]
    }

    /// The ranges of a layer's weights and biases in the parameters.
    pub fn place(&self, network: Network, layer: usize) -> (Range<usize>, Range<usize>) {
        let sizes = self.shape.windows(2).map(|l| (l[0] * l[1], l[1]));
        let one: usize = sizes.clone().map(|(weights, biases)| weights + biases).sum();
        let before: usize = sizes.clone().take(layer).map(|(w, b)| w + b).sum();
        let start = network as usize * one + before;
        let (weights, biases) = (self.shape[layer] * self.shape[layer + 1], self.shape[layer + 1]);
        (start..start + weights, start + weights..start + weights + biases)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PaperConfig;

    #[test]
    fn the_published_shape_has_1416_parameters_in_their_bounds() {
        let networks = Networks::new(&PaperConfig::default().networks, 0);
        assert_eq!(networks.shape, [3, 16, 16, 8]);
        assert_eq!(networks.parameters.len(), 1416);
        let (weights, biases) = networks.place(Network::Specular, 2);
        assert_eq!((weights.len(), biases.end), (128, 1416));
        let (first, _) = networks.place(Network::Light, 0);
        let largest = networks.parameters[first].iter().fold(0.0f32, |m, w| m.max(w.abs()));
        assert!(largest < 3f32.sqrt().recip() && largest > 0.5, "{largest}");
        assert_eq!(networks, Networks::new(&PaperConfig::default().networks, 0));
        assert_ne!(networks, Networks::new(&PaperConfig::default().networks, 1));
    }
}
