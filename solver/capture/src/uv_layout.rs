//! A check of a mesh's UV layout: every texel stands for one place, and seams are few.
//! The one check for captures, imports, and heads from files.

mod claims;
mod islands;
mod surface;

use std::collections::BTreeSet;

use glam::DVec2;

use surface::{LINE, twice_area};
pub use surface::{Layout, Parts};

/// Share of the texels in use that may stand for two places: folds of a decimated mesh.
const LARGEST_SHARE: f64 = 0.002;
/// Share of the surface that may lie on lines of the UVs, as slivers of fanned polygons do.
const LARGEST_COLLAPSED: f64 = 0.001;
/// Unwrapping tools round: this far outside of the unit square is inside.
const OUTSIDE: f64 = 1e-5;
/// Islands from which their seams are worth a warning.
const MANY_ISLANDS: usize = 100;

/// A layout that cannot carry maps; each message is what is wrong and the fix.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LayoutFault {
    /// There is no triangle with an area.
    #[error("all its triangles are without area; export the mesh again")]
    NoArea,
    /// Texture coordinates are NaN or infinite.
    #[error("{0} UVs are not finite; unwrap the mesh again")]
    NotFinite(usize),
    /// The UVs leave the unit square.
    #[error(
        "UVs reach from ({}, {}) to ({}, {}); move all islands into the unit square (one tile)",
        short(.low.x), short(.low.y), short(.high.x), short(.high.y)
    )]
    Outside {
        /// Least coordinates.
        low: DVec2,
        /// Largest coordinates.
        high: DVec2,
    },
    /// The UVs lie on several tiles.
    #[error(
        "UVs lie on {} tiles (UDIM {}); a map is one page, so unwrap the mesh again to one tile, \
         the unit square", .tiles.len(), .tiles.join(", ")
    )]
    Tiles {
        /// Their UDIM numbers, or their lower left corners where they have none.
        tiles: Vec<String>,
    },
    /// Some of the surface has no texels.
    #[error("{:.1} % of the surface has no area in UV; unwrap it", percent(.share))]
    Collapsed {
        /// The share of the surface's area.
        share: f64,
    },
    /// Several texture pages lie in one unit square.
    #[error(
        "{first} and {second} lie over each other in UV: two triangles claim {:.1} % of the texels \
         in use; unwrap the mesh again to one page, or leave out what is not the face", percent(.share)
    )]
    Pages {
        /// The share of the texels in use.
        share: f64,
        /// The two parts that share most texels.
        first: String,
        /// The other one.
        second: String,
    },
    /// A part of the mesh lies over itself.
    #[error(
        "{part} overlaps in UV{}: two triangles claim {:.1} % of the texels in use; unwrap it so \
         that every texel has one place", halves(.mirrored), percent(.share)
    )]
    Overlap {
        /// The share of the texels in use.
        share: f64,
        /// The part that most of them belong to.
        part: String,
        /// True if the triangles are mirror images.
        mirrored: bool,
    },
}

/// Checks a layout; gives the number of its islands that hold most of its area.
pub fn examine(layout: &Layout) -> Result<usize, LayoutFault> {
    let Layout { positions, uvs, triangles, parts } = layout;
    if triangles.is_empty() {
        return Err(LayoutFault::NoArea);
    }
    let infinite = uvs.iter().filter(|uv| !uv.is_finite()).count();
    if infinite > 0 {
        return Err(LayoutFault::NotFinite(infinite));
    }
    check_tile(uvs, triangles)?;
    if let Some(shared) = claims::shared(layout)
        && shared.share > LARGEST_SHARE
    {
        let share = shared.share;
        let [first, second] = shared.parts.map(|part| parts.names[part as usize].clone());
        return Err(if first == second {
            LayoutFault::Overlap { share, part: first, mirrored: shared.mirrored }
        } else {
            LayoutFault::Pages { share, first, second }
        });
    }
    let (mut whole, mut collapsed) = (0.0, 0.0);
    for triangle in *triangles {
        let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
        let area = (b - a).cross(c - a).length();
        whole += area;
        if twice_area(uvs, triangle).abs() <= LINE {
            collapsed += area;
        }
    }
    if collapsed > LARGEST_COLLAPSED * whole {
        return Err(LayoutFault::Collapsed { share: collapsed / whole });
    }
    Ok(islands::most(positions, uvs, triangles))
}

/// The warning of a layout with so many islands, if it deserves one.
pub fn islands_warning(islands: usize) -> Option<String> {
    (islands >= MANY_ISLANDS).then(|| {
        format!(
            "has {islands} UV islands; every seam costs a solve accuracy (384 islands lost 1.4 dB \
             of albedo, 1686 lost 8 dB, against the same mesh with one): unwrap it into fewer, as \
             Blender's Unwrap along marked seams does"
        )
    })
}

fn check_tile(uvs: &[DVec2], triangles: &[[u32; 3]]) -> Result<(), LayoutFault> {
    let corners = || triangles.iter().flatten().map(|corner| uvs[*corner as usize]);
    let low = corners().fold(DVec2::INFINITY, DVec2::min);
    let high = corners().fold(DVec2::NEG_INFINITY, DVec2::max);
    if low.min_element() >= -OUTSIDE && high.max_element() <= 1.0 + OUTSIDE {
        return Ok(());
    }
    let mut tiles = BTreeSet::new();
    for triangle in triangles {
        let corners = triangle.map(|corner| uvs[corner as usize]);
        let tile = (corners.iter().sum::<DVec2>() / 3.0).floor();
        // A triangle over a border lies on no page.
        let off = corners.iter().map(|uv| (*uv - tile - 0.5).abs().max_element() - 0.5);
        if off.fold(0.0, f64::max) > OUTSIDE {
            return Err(LayoutFault::Outside { low, high });
        }
        tiles.insert([tile.y as i64, tile.x as i64]);
    }
    if tiles.len() == 1 {
        return Err(LayoutFault::Outside { low, high });
    }
    let udim = |[v, u]: &[i64; 2]| match (0..10).contains(u) && (0..900).contains(v) {
        true => (1001 + u + 10 * v).to_string(),
        false => format!("({u}, {v})"),
    };
    let mut names: Vec<String> = tiles.iter().take(8).map(udim).collect();
    if tiles.len() > names.len() {
        names.push("...".to_owned());
    }
    Err(LayoutFault::Tiles { tiles: names })
}

fn percent(share: &f64) -> f64 {
    100.0 * share
}

fn halves(mirrored: &bool) -> &'static str {
    if *mirrored { " (mirrored halves)" } else { "" }
}

/// A number with three digits at most behind its point.
fn short(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

#[cfg(test)]
mod tests;
