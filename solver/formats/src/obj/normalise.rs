//! Rewrites an OBJ file as the plain text that tobj reads, and refuses faults by their line.

use std::collections::HashMap;

use super::error::ObjError;
use super::text::{Line, Lines, Values};

/// Name of an object without one.
const UNNAMED: &str = "geometry";
/// The lists that a corner's indices refer to, in their order.
const LISTS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// The faces of one object, in the order in which the plain text lists them.
pub(super) struct ObjectFaces {
    pub name: String,
    /// Names of materials (`usemtl`), in the order of their first use; "" without one.
    pub materials: Vec<String>,
    /// Index into `materials`, one per face.
    pub material_of: Vec<u32>,
    /// Line in the file, one per face.
    pub lines: Vec<usize>,
    /// Line of the first face that has a corner without texture coordinate.
    pub line_without_uv: Option<usize>,
    text: Vec<u8>,
}

/// Returns the plain text of a file and its objects in the order of their first faces.
///
/// The text lists all vertices, then the faces of each object after a line `o`, so that parts of
/// an object share vertices. Its indices are positive and within the lists. Faces of one or two
/// corners (points and lines), groups and curves are left out.
pub(super) fn normalise(bytes: &[u8]) -> Result<(Vec<u8>, Vec<ObjectFaces>), ObjError> {
    let mut file = File::default();
    for line in Lines::of(bytes)? {
        file.take(&line).map_err(|reason| ObjError { line: line.number, reason })?;
    }
    file.check()?;
    let mut text = file.text;
    for object in &mut file.objects {
        text.extend_from_slice(b"o object\n");
        text.append(&mut object.text);
    }
    Ok((text, file.objects))
}

#[derive(Default)]
struct File {
    /// The lines of vertices, texture coordinates and normals.
    text: Vec<u8>,
    /// Length of each list.
    counts: [usize; 3],
    /// The first face beyond the current length of a list: its line and the index into each list.
    ahead: Vec<(usize, [usize; 3])>,
    objects: Vec<ObjectFaces>,
    number_of: HashMap<String, usize>,
    object: Option<String>,
    material: String,
}

impl File {
    fn take(&mut self, line: &Line) -> Result<(), String> {
        let mut values = Values::of(&line.text);
        match values.keyword() {
            b"v" => {
                let [x, y, z] = values.numbers("a vertex")?;
                let weight =
                    if values.left() == 1 { values.numbers::<1>("a vertex")?[0] } else { 1.0 };
                if weight == 0.0 {
                    return Err("the vertex has weight 0; write it as x y z".to_owned());
                }
                self.list(0, format_args!("v {x} {y} {z} {weight}"));
            }
            b"vt" => {
                let [u, v] = values.numbers("a texture coordinate")?;
                self.list(1, format_args!("vt {u} {v}"));
            }
            b"vn" => {
                let [x, y, z] = values.numbers("a normal")?;
                self.list(2, format_args!("vn {x} {y} {z}"));
            }
            b"f" => self.face(line.number, values)?,
            b"o" => self.object = Some(values.rest()).filter(|name| !name.is_empty()),
            b"usemtl" => self.material = values.rest(),
            _ => {}
        }
        Ok(())
    }

    fn list(&mut self, list: usize, line: std::fmt::Arguments) {
        self.text.extend_from_slice(format!("{line}\n").as_bytes());
        self.counts[list] += 1;
    }

    fn face(&mut self, line: usize, values: Values) -> Result<(), String> {
        let corners = values.map(|word| self.corner(word)).collect::<Result<Vec<_>, _>>()?;
        if corners.len() < 3 {
            return Ok(());
        }
        let largest = |list: usize| corners.iter().map(|corner| corner[list]).max().unwrap_or(0);
        let largest = [largest(0), largest(1), largest(2)];
        // Faces may stand before their vertices.
        if largest.iter().zip(self.counts).any(|(index, count)| *index > count) {
            self.ahead.push((line, largest));
        }
        let name = self.object.as_deref().unwrap_or(UNNAMED);
        let number = match self.number_of.get(name) {
            Some(number) => *number,
            None => {
                self.number_of.insert(name.to_owned(), self.objects.len());
                self.objects.push(ObjectFaces::new(name));
                self.objects.len() - 1
            }
        };
        self.objects[number].push(line, &self.material, &corners);
        Ok(())
    }

    /// The indices of a corner from 1; 0 where it has none.
    fn corner(&self, word: &[u8]) -> Result<[usize; 3], String> {
        let shown = String::from_utf8_lossy(word);
        let mut corner = [0; 3];
        for (list, part) in word.split(|byte| *byte == b'/').enumerate() {
            if list == 3 || (list == 0 && part.is_empty()) {
                return Err(format!("{shown:?} is not a corner; write vertex/uv/normal"));
            }
            if !part.is_empty() {
                let count = self.counts[list];
                corner[list] = resolved(part, count).ok_or_else(|| {
                    format!("{shown:?} names no {}; there are {count} so far", LISTS[list])
                })?;
            }
        }
        Ok(corner)
    }

    /// Refuses indices beyond the end of the file's lists.
    fn check(&self) -> Result<(), ObjError> {
        for (line, largest) in &self.ahead {
            for ((what, index), count) in LISTS.iter().zip(largest).zip(self.counts) {
                if *index > count {
                    let reason = format!("names {what} {index}, but there are {count}");
                    return Err(ObjError { line: *line, reason });
                }
            }
        }
        Ok(())
    }
}

impl ObjectFaces {
    fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            materials: vec![],
            material_of: vec![],
            lines: vec![],
            line_without_uv: None,
            text: vec![],
        }
    }

    fn push(&mut self, line: usize, material: &str, corners: &[[usize; 3]]) {
        let known = self.materials.iter().position(|name| name == material);
        let material = known.unwrap_or_else(|| {
            self.materials.push(material.to_owned());
            self.materials.len() - 1
        });
        self.material_of.push(material as u32);
        self.lines.push(line);
        if corners.iter().any(|corner| corner[1] == 0) {
            self.line_without_uv.get_or_insert(line);
        }
        self.text.push(b'f');
        for [position, uv, normal] in corners {
            let [uv, normal] = [uv, normal].map(|index| match index {
                0 => String::new(),
                index => index.to_string(),
            });
            self.text.extend_from_slice(format!(" {position}/{uv}/{normal}").as_bytes());
        }
        self.text.push(b'\n');
    }
}

/// An index from 1, or from the end of the `count` so far if it is negative, as one from 1.
fn resolved(word: &[u8], count: usize) -> Option<usize> {
    let index: i64 = std::str::from_utf8(word).ok()?.parse().ok()?;
    let index = if index < 0 { index.checked_add(count as i64)? + 1 } else { index };
    usize::try_from(index).ok().filter(|index| (1..u32::MAX as usize).contains(index))
}
