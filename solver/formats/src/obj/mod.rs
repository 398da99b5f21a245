//! Wavefront OBJ files: the one reader, for captures and for your own heads.
//!
//! tobj reads them, after [`normalise`] has rewritten what modellers write and tobj 4 refuses or
//! misreads: Latin-1, continued lines, `usemtl` without a name, objects in several parts. Its
//! errors name the line. Polygons are cut by earcut, because a fan folds concave ones.

mod error;
mod normalise;
mod polygon;
mod text;

pub use error::ObjError;
use normalise::{ObjectFaces, normalise};
use polygon::{Cutter, Place};

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
    let (text, objects) = normalise(bytes)?;
    if objects.is_empty() {
        return Ok(vec![]);
    }
    let options = tobj::LoadOptions { single_index: true, ..Default::default() };
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut text.as_slice(), &options, no_materials)
        .map_err(|error| ObjError { line: 1, reason: error.to_string() })?;
    let mut cutter = Cutter::default();
    objects
        .into_iter()
        .zip(models)
        .map(|(faces, model)| Object::from_mesh(faces, &model.mesh, &mut cutter))
        .collect()
}

impl Object {
    fn from_mesh(
        faces: ObjectFaces,
        mesh: &tobj::Mesh,
        cutter: &mut Cutter,
    ) -> Result<Self, ObjError> {
        let positions: Vec<[f64; 3]> = mesh.positions.as_chunks().0.to_vec();
        let count = positions.len();
        // tobj leaves out what a corner does not have.
        let complete = |length: usize| length == count;
        let uvs = Some(mesh.texcoords.as_chunks().0.to_vec()).filter(|uvs| complete(uvs.len()));
        let normals = Some(mesh.normals.as_chunks().0.to_vec()).filter(|n| complete(n.len()));
        let place = |vertex: u32| Place {
            position: positions[vertex as usize],
            uv: uvs.as_ref().map(|uvs: &Vec<[f64; 2]>| uvs[vertex as usize]),
        };
        let (mut triangles, mut material_of) = (vec![], vec![]);
        let mut rest = mesh.indices.as_slice();
        for (face, line) in faces.lines.iter().enumerate() {
            // tobj gives no numbers of corners where all are three.
            let arity = mesh.face_arities.get(face).map_or(3, |arity| *arity as usize);
            let (corners, after) = rest.split_at(arity);
            rest = after;
            let cut = cutter
                .cut(arity, |corner| place(corners[corner]))
                .map_err(|reason| ObjError { line: *line, reason })?;
            for triangle in cut {
                triangles.push(triangle.map(|corner| corners[corner]));
                material_of.push(faces.material_of[face]);
            }
        }
        let ObjectFaces { name, materials, line_without_uv, .. } = faces;
        Ok(Self {
            name,
            positions,
            uvs,
            normals,
            triangles,
            materials,
            material_of,
            line_without_uv,
        })
    }
}

#[cfg(test)]
mod tests;
