//! Small captures with a known answer, for tests.

use std::path::Path;

use glam::{Mat3, Mat4, Vec2, Vec3};

use capture::gbuffer::rasterise;
use capture::{Camera, Mesh, View};
use formats::picture::{self, GrayImage, Picture};

/// The square -1..1 in the plane z = 0 with the whole unit square as its chart, facing +z.
pub fn square() -> Mesh {
    let at = |x: f32, y: f32| Vec3::new(x, y, 0.0);
    Mesh {
        positions: vec![at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)],
        normals: vec![Vec3::Z; 4],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// The part of the unit sphere around +z with z >= 0.2; its chart is a disc of radius 0.4 in the
/// middle of the unit square, in equidistant projection. `rings` rings of 4 * `rings` points.
pub fn dome(rings: usize) -> Mesh {
    let around = 4 * rings;
    let mut mesh = Mesh {
        positions: vec![Vec3::Z],
        normals: vec![],
        uvs: vec![Vec2::splat(0.5)],
        triangles: vec![],
    };
    for ring in 1..=rings {
        let fraction = ring as f32 / rings as f32;
        let polar = fraction * 0.2_f32.acos();
        for step in 0..around {
            let turn = step as f32 / around as f32 * std::f32::consts::TAU;
            let direction = Vec2::from_angle(turn);
            mesh.positions.push((direction * polar.sin()).extend(polar.cos()));
            mesh.uvs.push(Vec2::splat(0.5) + 0.4 * fraction * direction);
        }
    }
    let index = |ring: usize, step: usize| match ring {
        0 => 0,
        _ => (1 + (ring - 1) * around + step % around) as u32,
    };
    for ring in 0..rings {
        for step in 0..around {
            let [a, b] = [index(ring, step), index(ring, step + 1)];
            let [c, d] = [index(ring + 1, step), index(ring + 1, step + 1)];
            mesh.triangles.push([a, c, d]);
            if ring > 0 {
                mesh.triangles.push([a, d, b]);
            }
        }
    }
    mesh.normals = mesh.positions.clone();
    mesh
}

/// A square camera that looks at the origin from `position`, its field of view two units wide
/// there at least.
pub fn camera(name: &str, position: Vec3, size: usize) -> Camera {
    let back = position.normalize();
    let right = Vec3::Y.cross(back).normalize();
    let axes = Mat3::from_cols(right, back.cross(right), back);
    Camera {
        name: name.to_owned(),
        width: size,
        height: size,
        focal: [size as f32 * position.length() / 2.5; 2],
        centre: [size as f32 / 2.0; 2],
        camera_to_world: Mat4::from_translation(position) * Mat4::from_mat3(axes),
    }
}

/// Cameras around a point in front of the origin.
pub fn rig(count: usize, size: usize) -> Vec<Camera> {
    let place = |index: usize| {
        let side = (index as f32 - (count as f32 - 1.0) / 2.0) * 0.8;
        camera(&format!("{index:03}"), Vec3::new(side, 0.3, 3.0), size)
    };
    (0..count).map(place).collect()
}

/// A view of `mesh` whose colours and labels are a function of the position; black elsewhere.
pub fn view(mesh: &Mesh, camera: &Camera, shade: impl Fn(Vec3) -> (Vec3, u8)) -> View {
    let (width, height) = (camera.width, camera.height);
    let mut view = View {
        camera: camera.clone(),
        image: Picture::new(width, height, 3),
        mask: GrayImage::new(width, height),
        labels: Some(GrayImage::new(width, height)),
    };
    for (pixel, hit) in rasterise(mesh, camera).hits.iter().enumerate() {
        let Some(hit) = hit.filter(|hit| hit.front) else { continue };
        let corners = mesh.triangles[hit.triangle as usize].map(|c| mesh.positions[c as usize]);
        let weights = hit.barycentric.to_array();
        let (colour, label) = shade((0..3).map(|i| corners[i] * weights[i]).sum());
        view.image.data[3 * pixel..3 * pixel + 3].copy_from_slice(&colour.to_array());
        view.mask.data[pixel] = 255;
        view.labels.as_mut().unwrap().data[pixel] = label;
    }
    view
}

/// Writes a capture folder of these views; the last `withheld` ones are test frames.
pub fn write_capture(folder: &Path, mesh: &Mesh, views: &[View], withheld: usize) {
    for part in ["images", "masks", "labels"] {
        std::fs::create_dir_all(folder.join(part)).unwrap();
    }
    std::fs::write(folder.join("mesh.obj"), obj(mesh)).unwrap();
    let mut frames = Vec::new();
    for View { camera, image, mask, labels } in views {
        let name = &camera.name;
        let [file, mask_file, label_file] =
            [("images", "exr"), ("masks", "png"), ("labels", "png")]
                .map(|(part, ending)| format!("{part}/{name}.{ending}"));
        picture::write_exr_rgb(&folder.join(&file), image).unwrap();
        picture::write_png_gray(&folder.join(&mask_file), mask).unwrap();
        picture::write_png_gray(&folder.join(&label_file), labels.as_ref().unwrap()).unwrap();
        frames.push(serde_json::json!({
            "name": name, "file_path": file, "mask_path": mask_file, "label_path": label_file,
            "w": camera.width, "h": camera.height,
            "fl_x": camera.focal[0], "fl_y": camera.focal[1],
            "cx": camera.centre[0], "cy": camera.centre[1],
            "transform_matrix": camera.camera_to_world.transpose().to_cols_array_2d(),
        }));
    }
    let names: Vec<_> = frames.iter().map(|frame| frame["file_path"].clone()).collect();
    let (train, test) = names.split_at(names.len() - withheld);
    let transforms = serde_json::json!({
        "camera_model": "PINHOLE", "mesh": "mesh.obj", "frames": frames,
        "train_filenames": train, "test_filenames": test,
        "label_names": { "1": "skin", "2": "lips", "3": "scalp" },
    });
    std::fs::write(folder.join("transforms.json"), transforms.to_string()).unwrap();
}

fn obj(mesh: &Mesh) -> String {
    let mut text = String::new();
    for p in &mesh.positions {
        text += &format!("v {} {} {}\n", p.x, p.y, p.z);
    }
    for n in &mesh.normals {
        text += &format!("vn {} {} {}\n", n.x, n.y, n.z);
    }
    for uv in &mesh.uvs {
        text += &format!("vt {} {}\n", uv.x, uv.y);
    }
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|corner| corner + 1);
        text += &format!("f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}\n");
    }
    text
}

/// Runs `work` on a pool of `threads` threads.
pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}
