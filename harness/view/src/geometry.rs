//! The mesh as arrays of a page.

use std::path::Path;

use capture::Mesh;
use glam::Vec3;
use serde::Serialize;

use crate::error::ViewError;
use crate::packed::{Array, Element, Stored};
use crate::visibility;

/// The largest code of sixteen bits.
const TOP: f32 = 65535.0;

/// The mesh as the page reads it. Positions are codes between the corners of its box, normals between -1 and 1,
/// texture coordinates between 0 and 1.
#[derive(Serialize)]
pub(crate) struct Geometry {
    /// The box's corners, metres.
    low: [f32; 3],
    high: [f32; 3],
    positions: Stored,
    normals: Stored,
    uvs: Stored,
    triangles: Stored,
    /// Bits of the directions that are not blocked.
    visibility: Stored,
}

impl Geometry {
    /// Writes the arrays into the page's folder.
    pub fn write(mesh: &Mesh, folder: &Path) -> Result<Self, ViewError> {
        let (low, high) = mesh.bounds();
        let code = |value: f32| (value.clamp(0.0, 1.0) * TOP).round() as u32;
        let size = (high - low).max(Vec3::splat(f32::MIN_POSITIVE));
        let positions = mesh.positions.iter().flat_map(|p| ((*p - low) / size).to_array());
        let normals = mesh.normals.iter().flat_map(|n| (*n * 0.5 + 0.5).to_array());
        let uvs = mesh.uvs.iter().flat_map(|uv| uv.to_array());
        let list = |channels, values: Vec<f32>| {
            Array::list(Element::U16, channels, values.into_iter().map(code).collect())
        };
        let triangles = mesh.triangles.iter().flatten().copied().collect();
        Ok(Self {
            low: low.to_array(),
            high: (low + size).to_array(),
            positions: list(3, positions.collect()).write(folder, "positions")?,
            normals: list(3, normals.collect()).write(folder, "normals")?,
            uvs: list(2, uvs.collect()).write(folder, "uvs")?,
            triangles: Array::list(Element::U32, 3, triangles).write(folder, "triangles")?,
            visibility: visibility::bits(mesh).write(folder, "visibility")?,
        })
    }
}
