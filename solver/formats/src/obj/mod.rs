//! Wavefront OBJ files: the one reader, for captures and for heads of one's own.
//!
//! No crate reads what modellers write: tobj 4 refuses Latin-1, continued lines and `usemtl`
//! without a name, cuts concave polygons as fans, pairs texture coordinates with wrong vertices
//! where some corners have none, and names no line. Polygons are cut by the crate `earcut`.

mod error;
mod polygon;
mod text;

use std::collections::HashMap;

pub use error::ObjError;
use polygon::Place;
use text::{Lines, Values};

/// Name of an object without one.
const UNNAMED: &str = "geometry";
/// No index: the corner has no texture coordinate or no normal.
const NONE: u32 = u32::MAX;

/// One object of a file (`o`), in the file's units and axes: triangles whose vertices are split
/// where texture coordinates or normals are, in the order of their first use.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Text after `o`; "geometry" without one.
    pub name: String,
    /// One per vertex; as the file has them, so perhaps not finite.
    pub positions: Vec<[f64; 3]>,
    /// u right, v up, one per vertex; `None` if some corners of the object have none.
    pub uvs: Option<Vec<[f64; 2]>>,
    /// One per vertex; `None` if some corners of the object have none.
    pub normals: Option<Vec<[f64; 3]>>,
    /// Vertex indices, in the file's winding.
    pub triangles: Vec<[u32; 3]>,
    /// Names of the object's materials (`usemtl`), in the order of their first use; "" without one.
    pub materials: Vec<String>,
    /// Index into `materials`, one per triangle.
    pub material_of: Vec<u32>,
    /// Line of the object's first face that has a corner without texture coordinate.
    pub line_without_uv: Option<usize>,
}

/// Reads the objects that have faces, in the order of their first faces; polygons become
/// triangles. Groups, lines, points and curves are no geometry of a surface and are skipped.
pub fn read(bytes: &[u8]) -> Result<Vec<Object>, ObjError> {
    let mut file = File::default();
    for line in Lines::of(bytes)? {
        let number = line.number;
        file.take(line).map_err(|reason| ObjError { line: number, reason })?;
    }
    file.into_objects()
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Corner {
    position: u32,
    uv: u32,
    normal: u32,
}

struct Face {
    line: usize,
    object: usize,
    material: usize,
    /// Corners, as a range of `File::corners`.
    first: usize,
    count: usize,
}

#[derive(Default)]
struct File {
    positions: Vec<[f64; 3]>,
    uvs: Vec<[f64; 2]>,
    normals: Vec<[f64; 3]>,
    corners: Vec<Corner>,
    faces: Vec<Face>,
    objects: Names,
    materials: Names,
    object: Option<usize>,
    material: Option<usize>,
}

/// Names and their numbers, in the order of their first use.
#[derive(Default)]
struct Names {
    names: Vec<String>,
    numbers: HashMap<String, usize>,
}

impl Names {
    fn number(&mut self, name: &str) -> usize {
        if let Some(number) = self.numbers.get(name) {
            return *number;
        }
        self.names.push(name.to_owned());
        self.numbers.insert(name.to_owned(), self.names.len() - 1);
        self.names.len() - 1
    }
}

impl File {
    fn take(&mut self, line: text::Line) -> Result<(), String> {
        let mut values = Values::of(&line.text);
        match values.keyword() {
            b"v" => {
                let [x, y, z] = values.numbers("a vertex")?;
                let weight =
                    if values.left() == 1 { values.numbers::<1>("a vertex")?[0] } else { 1.0 };
                if weight == 0.0 {
                    return Err("the vertex has weight 0; write it as x y z".to_owned());
                }
                self.positions.push([x / weight, y / weight, z / weight]);
            }
            b"vt" => self.uvs.push(values.numbers("a texture coordinate")?),
            b"vn" => self.normals.push(values.numbers("a normal")?),
            b"f" => self.face(line.number, values)?,
            b"o" => self.object = Some(self.object_number(&values.rest())),
            b"usemtl" => self.material = Some(self.materials.number(&values.rest())),
            _ => {}
        }
        Ok(())
    }

    fn object_number(&mut self, name: &str) -> usize {
        self.objects.number(if name.is_empty() { UNNAMED } else { name })
    }

    fn face(&mut self, line: usize, values: Values) -> Result<(), String> {
        let first = self.corners.len();
        for word in values {
            let shown = String::from_utf8_lossy(word);
            let mut parts = word.split(|byte| *byte == b'/');
            let mut index = |what: &str, count: usize| match parts.next() {
                None | Some(b"") => Ok(NONE),
                Some(part) => resolved(part, count)
                    .ok_or_else(|| format!("{shown:?} names no {what}; there are {count} so far")),
            };
            let position = index("vertex", self.positions.len())?;
            let uv = index("texture coordinate", self.uvs.len())?;
            let normal = index("normal", self.normals.len())?;
            if position == NONE || parts.next().is_some() {
                return Err(format!("{shown:?} is not a corner; write vertex/uv/normal"));
            }
            self.corners.push(Corner { position, uv, normal });
        }
        let count = self.corners.len() - first;
        if count < 3 {
            // A line or a point.
            self.corners.truncate(first);
            return Ok(());
        }
        let object = match self.object {
            Some(object) => object,
            None => self.object_number(""),
        };
        let material = match self.material {
            Some(material) => material,
            None => self.materials.number(""),
        };
        self.faces.push(Face { line, object, material, first, count });
        Ok(())
    }

    fn into_objects(self) -> Result<Vec<Object>, ObjError> {
        /// An object with its vertices by corner and its materials by their numbers in the file.
        type Part = (Object, HashMap<Corner, u32>, HashMap<usize, u32>);
        let mut parts: Vec<Part> = Vec::new();
        let mut number_of = vec![None; self.objects.names.len()];
        let mut cutter = polygon::Cutter::default();
        for face in &self.faces {
            let corners = &self.corners[face.first..face.first + face.count];
            let at = |reason: String| ObjError { line: face.line, reason };
            self.check(corners).map_err(at)?;
            let number = *number_of[face.object].get_or_insert_with(|| {
                let object = Object::new(&self.objects.names[face.object]);
                parts.push((object, HashMap::new(), HashMap::new()));
                parts.len() - 1
            });
            let (object, known, known_materials) = &mut parts[number];
            let material = *known_materials.entry(face.material).or_insert_with(|| {
                object.materials.push(self.materials.names[face.material].clone());
                object.materials.len() as u32 - 1
            });
            if corners.iter().any(|corner| corner.uv == NONE) {
                object.line_without_uv.get_or_insert(face.line);
                object.uvs = None;
            }
            if corners.iter().any(|corner| corner.normal == NONE) {
                object.normals = None;
            }
            let place = |corner: &Corner| Place {
                position: self.positions[corner.position as usize],
                uv: self.uvs.get(corner.uv as usize).copied(),
            };
            let cut = cutter.cut(corners.len(), |i| place(&corners[i])).map_err(at)?;
            for triangle in cut {
                let triangle = triangle.map(|i| corners[i]).map(|corner| {
                    *known.entry(corner).or_insert_with(|| object.add(&self, corner))
                });
                object.triangles.push(triangle);
                object.material_of.push(material);
            }
        }
        Ok(parts.into_iter().map(|(object, ..)| object).collect())
    }

    /// Refuses indices beyond the end of the file's lists; faces may stand before their vertices.
    fn check(&self, corners: &[Corner]) -> Result<(), String> {
        for corner in corners {
            let lists = [
                ("vertex", corner.position, self.positions.len()),
                ("texture coordinate", corner.uv, self.uvs.len()),
                ("normal", corner.normal, self.normals.len()),
            ];
            for (what, index, count) in lists {
                if index != NONE && index as usize >= count {
                    let number = u64::from(index) + 1;
                    return Err(format!("names {what} {number}, but there are {count}"));
                }
            }
        }
        Ok(())
    }
}

impl Object {
    fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            positions: vec![],
            uvs: Some(vec![]),
            normals: Some(vec![]),
            triangles: vec![],
            materials: vec![],
            material_of: vec![],
            line_without_uv: None,
        }
    }

    /// Adds a vertex and gives its index.
    fn add(&mut self, file: &File, corner: Corner) -> u32 {
        self.positions.push(file.positions[corner.position as usize]);
        if let (Some(uvs), Some(uv)) = (&mut self.uvs, file.uvs.get(corner.uv as usize)) {
            uvs.push(*uv);
        }
        let normal = file.normals.get(corner.normal as usize);
        if let (Some(normals), Some(normal)) = (&mut self.normals, normal) {
            normals.push(*normal);
        }
        self.positions.len() as u32 - 1
    }
}

/// An index from 1, or from the end of the `count` so far if it is negative, as one from 0.
fn resolved(word: &[u8], count: usize) -> Option<u32> {
    let index: i64 = std::str::from_utf8(word).ok()?.parse().ok()?;
    let index = if index < 0 { index.checked_add(count as i64)? } else { index - 1 };
    u32::try_from(index).ok().filter(|index| *index != NONE)
}

#[cfg(test)]
mod tests;
