//! The mesh: triangles with one normal and one texture coordinate per vertex.

use std::collections::HashMap;
use std::path::Path;

use formats::obj;
use glam::{Vec2, Vec3};

use super::error::CaptureError;
use super::uv_layout::Parts;
use super::winding::Winding;

/// A triangle mesh; every vertex has a position, a unit normal and a texture coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Metres, world space.
    pub positions: Vec<Vec3>,
    /// Unit, world space; from the file, or area-weighted if it has none.
    pub normals: Vec<Vec3>,
    /// u right, v up, inside the unit square.
    pub uvs: Vec<Vec2>,
    /// Vertex indices, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Reads an OBJ file; all its objects become one mesh.
    pub fn open(path: &Path) -> Result<Self, CaptureError> {
        Self::open_with_parts(path).map(|(mesh, _)| mesh)
    }

    /// [`Mesh::open`], with the material or object of each triangle.
    pub(crate) fn open_with_parts(path: &Path) -> Result<(Self, Parts), CaptureError> {
        let bytes = std::fs::read(path).map_err(|error| CaptureError::Read {
            path: path.to_path_buf(),
            reason: error.to_string(),
        })?;
        Self::parse(&bytes)
            .map_err(|reason| CaptureError::Mesh { path: path.to_path_buf(), reason })
    }

    /// Reads an OBJ file in memory; `path` is for messages.
    pub fn from_bytes(path: &Path, bytes: &[u8]) -> Result<Self, CaptureError> {
        Self::parse(bytes)
            .map(|(mesh, _)| mesh)
            .map_err(|reason| CaptureError::Mesh { path: path.to_path_buf(), reason })
    }

    fn parse(bytes: &[u8]) -> Result<(Self, Parts), String> {
        let mut parts = Parts::default();
        let mut mesh = Self { positions: vec![], normals: vec![], uvs: vec![], triangles: vec![] };
        let mut normals_given = true;
        for part in obj::read(bytes).map_err(|error| error.to_string())? {
            let base = mesh.positions.len() as u32;
            parts.add(&part);
            let Some(uvs) = part.uvs else {
                let (name, line) = (part.name, part.line_without_uv.unwrap_or_default());
                return Err(format!(
                    "line {line}: object {name:?} has no texture coordinates; unwrap it, or take \
                     it out of the file"
                ));
            };
            normals_given &= part.normals.is_some();
            mesh.positions.extend(part.positions.iter().map(|p| Vec3::from_array(p.map(single))));
            mesh.normals
                .extend(part.normals.iter().flatten().map(|n| Vec3::from_array(n.map(single))));
            mesh.uvs.extend(uvs.iter().map(|uv| Vec2::from_array(uv.map(single))));
            mesh.triangles.extend(part.triangles.iter().map(|t| t.map(|corner| corner + base)));
        }
        if !normals_given || mesh.normals.contains(&Vec3::ZERO) {
            mesh.normals = vertex_normals(&mesh.positions, &wound_alike(&mesh));
        }
        mesh.check()?;
        for normal in &mut mesh.normals {
            // Only a vertex without area can have none; no pixel ever meets it.
            *normal = normal.normalize_or(Vec3::Z);
        }
        Ok((mesh, parts))
    }

    /// Opposite corners of the smallest box around the mesh, the least coordinates first.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let empty = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        self.positions.iter().fold(empty, |(low, high), p| (low.min(*p), high.max(*p)))
    }

    fn check(&self) -> Result<(), String> {
        if self.triangles.is_empty() {
            return Err("has no triangles".to_owned());
        }
        let finite = |v: &Vec3| v.is_finite();
        if let Some(i) = self.positions.iter().position(|p| !finite(p)) {
            return Err(format!("vertex {} is not finite; remove it", i + 1));
        }
        if let Some(i) = self.normals.iter().position(|n| !finite(n)) {
            return Err(format!("normal of vertex {} is not finite; recompute the normals", i + 1));
        }
        // Unwrapping tools round: a hair outside is inside.
        let inside = |uv: &Vec2| (*uv - Vec2::splat(0.5)).abs().max_element() <= 0.5 + 1e-5;
        if let Some(uv) = self.uvs.iter().find(|uv| !inside(uv)) {
            let place = format!("texture coordinate ({}, {})", uv.x, uv.y);
            return Err(format!("{place} is outside the unit square; rescale the chart"));
        }
        Ok(())
    }
}

fn single(value: f64) -> f32 {
    value as f32
}

/// The triangles, each wound as most of its surface is.
fn wound_alike(mesh: &Mesh) -> Vec<[u32; 3]> {
    let winding = Winding::of(&mesh.positions, &places(&mesh.positions), &mesh.triangles);
    let triangles = mesh.triangles.iter().zip(winding.flipped);
    triangles
        .map(|([a, b, c], flipped)| if flipped { [*a, *c, *b] } else { [*a, *b, *c] })
        .collect()
}

/// Sums of the adjacent triangles' normals, weighted by their areas; vertices at one place, as
/// seams and unwelded triangles have them, share theirs.
fn vertex_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let place = places(positions);
    let mut sums = vec![Vec3::ZERO; positions.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| positions[corner as usize]);
        let area_normal = (b - a).cross(c - a);
        for corner in corners {
            sums[place[*corner as usize]] += area_normal;
        }
    }
    place.into_iter().map(|place| sums[place]).collect()
}

/// For each vertex, the index of the first vertex at the same position.
pub(super) fn places(positions: &[Vec3]) -> Vec<usize> {
    let mut first = HashMap::with_capacity(positions.len());
    // Adding zero makes the two zeros one.
    let bits = |position: &Vec3| (position + Vec3::ZERO).to_array().map(f32::to_bits);
    (0..positions.len()).map(|i| *first.entry(bits(&positions[i])).or_insert(i)).collect()
}
