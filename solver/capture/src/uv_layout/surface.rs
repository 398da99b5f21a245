//! A surface with its UV layout, and the parts that its triangles belong to.

use formats::obj::Object;
use glam::{DVec2, DVec3};

/// Twice the area in UV below which a triangle lies on a line.
pub(super) const LINE: f64 = 1e-14;

/// A surface with its UV layout.
pub struct Layout<'a> {
    /// One per vertex, in any unit.
    pub positions: &'a [DVec3],
    /// One per vertex, u right, v up.
    pub uvs: &'a [DVec2],
    /// Vertex indices.
    pub triangles: &'a [[u32; 3]],
    /// The owners of the triangles.
    pub parts: &'a Parts,
}

/// The materials that triangles belong to, or the objects where a file names no material.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// In words: `material "skin"`.
    pub names: Vec<String>,
    /// Index into `names`, one per triangle.
    pub of: Vec<u32>,
}

impl Parts {
    /// Appends the triangles of an object of a file.
    pub fn add(&mut self, object: &Object) {
        let words = |material: &String| match material.as_str() {
            "" => format!("object {:?}", object.name),
            name => format!("material {name:?}"),
        };
        let numbers: Vec<u32> =
            object.materials.iter().map(|material| self.number(words(material))).collect();
        self.of.extend(object.material_of.iter().map(|material| numbers[*material as usize]));
    }

    fn number(&mut self, name: String) -> u32 {
        let known = self.names.iter().position(|other| *other == name);
        known.unwrap_or_else(|| {
            self.names.push(name);
            self.names.len() - 1
        }) as u32
    }
}

/// Twice the signed area of a triangle in UV, counter-clockwise positive.
pub(super) fn twice_area(uvs: &[DVec2], triangle: &[u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|corner| uvs[corner as usize]);
    (b - a).perp_dot(c - a)
}
