//! The three numbers that plots show of a method in a case.

use crate::table::Column;

/// A number of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// Diffuse albedo after its one factor, PSNR of sRGB values.
    Albedo,
    /// Withheld views with the maps relit in other lights than the capture's, the mean of their PSNR.
    Relit,
    /// Mean angle of the specular normal.
    Normal,
}

impl Quantity {
    pub const ALL: [Self; 3] = [Self::Albedo, Self::Relit, Self::Normal];

    pub fn name(self) -> &'static str {
        match self {
            Self::Albedo => "diffuse albedo",
            Self::Relit => "relit in other lights",
            Self::Normal => "specular normal",
        }
    }

    pub fn label(self) -> &'static str {
        match self {
            Self::Albedo => "diffuse albedo, PSNR, dB ↑",
            Self::Relit => "relit, other lights, PSNR, dB ↑",
            Self::Normal => "specular normal, mean angle, ° ↓",
        }
    }

    /// The value of a column in a case captured in the light `own`; none if it was not scored.
    pub fn find(self, column: &Column, own: &str) -> Option<f64> {
        match self {
            Self::Albedo => column.find("diffuse_albedo", None, "psnr_srgb", "global")?.value,
            Self::Normal => column.find("specular_normal", None, "normal_mean_deg", "none")?.value,
            Self::Relit => {
                let mut lights: Vec<&str> =
                    column.rows().iter().filter_map(|row| row.light.as_deref()).collect();
                lights.sort_unstable();
                lights.dedup();
                lights.retain(|light| *light != own);
                let rows = lights.iter().filter_map(|light| {
                    column.find("relit", Some(light), "psnr_srgb", "global")?.value
                });
                let values: Vec<f64> = rows.collect();
                (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
            }
        }
    }
}
