use std::fs;
use std::path::Path;

use formats::picture::{self, GrayImage, Picture};
use glam::Vec3;
use serde_json::{Value, json};

use super::*;
use crate::testing;

fn written(folder: &Path) -> Vec<View> {
    let mesh = testing::dome(6);
    let shade = |p: Vec3| (p.abs(), if p.x < 0.0 { 1 } else { 2 });
    let views: Vec<View> =
        testing::rig(3, 16).iter().map(|camera| testing::view(&mesh, camera, shade)).collect();
    testing::write_capture(folder, &mesh, &views, 1);
    views
}

#[test]
fn what_was_written_is_opened_and_withheld_pictures_are_not() {
    let folder = tempfile::tempdir().unwrap();
    let views = written(folder.path());
    for part in ["images/002.exr", "masks/002.png", "labels/002.png"] {
        fs::remove_file(folder.path().join(part)).unwrap();
    }
    let capture = Capture::open(folder.path()).unwrap();
    assert_eq!(capture.train, views[..2]);
    assert_eq!(capture.withheld, [views[2].camera.clone()]);
    assert_eq!(capture.camera("002"), Some(&views[2].camera));
    assert_eq!(capture.camera("003"), None);
    let mesh = testing::dome(6);
    assert_eq!(capture.mesh.triangles.len(), mesh.triangles.len());
    let corners = |mesh: &Mesh| -> Vec<Vec3> {
        mesh.triangles.iter().flatten().map(|corner| mesh.positions[*corner as usize]).collect()
    };
    assert_eq!(corners(&capture.mesh), corners(&mesh));
}

#[test]
fn the_hash_changes_with_every_input_and_with_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    written(folder.path());
    let hash = || Capture::open(folder.path()).unwrap().hash().to_owned();
    let before = hash();
    assert_eq!(before.len(), 64);
    fs::write(folder.path().join("images/002.exr"), "changed").unwrap();
    fs::create_dir(folder.path().join("truth")).unwrap();
    assert_eq!(hash(), before);
    let path = folder.path().join("labels/001.png");
    let mut labels = picture::read_png_gray(&path).unwrap();
    labels.data[0] = 9;
    picture::write_png_gray(&path, &labels).unwrap();
    assert_ne!(hash(), before);
}

#[test]
fn normals_are_computed_if_the_file_has_none() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.obj");
    let text =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    fs::write(&path, text).unwrap();
    let mesh = Mesh::open(&path).unwrap();
    assert_eq!(mesh.triangles.len(), 2, "a quadrilateral becomes two triangles");
    assert_eq!(mesh.normals, [Vec3::Z; 4]);
}

#[test]
fn half_a_view_averages_votes_and_keeps_a_pixel_only_if_all_four_are_valid() {
    let (width, height) = (5, 3);
    let image = Picture { width, height, channels: 3, data: (0..45).map(|v| v as f32).collect() };
    let mut mask = GrayImage { width, height, data: vec![255; 15] };
    mask.data[8] = 0;
    let ids = vec![7, 3, 2, 2, 9, 3, 7, 4, 1, 9, 9, 9, 9, 9, 9];
    let labels = Some(GrayImage { width, height, data: ids });
    let mut camera = testing::camera("a", Vec3::Z, 4);
    (camera.width, camera.height) = (width, height);
    let half = View { camera, image, mask, labels }.half();
    assert_eq!((half.camera.width, half.camera.height), (2, 1));
    // Pixels 0, 1, 5, 6 and 2, 3, 7, 8 of three channels each.
    assert_eq!(half.image.data, [9.0, 10.0, 11.0, 15.0, 16.0, 17.0]);
    assert_eq!(half.mask.data, [255, 0]);
    assert_eq!(half.labels.unwrap().data, [3, 2]);
}

/// Breaks one thing and returns the message.
fn broken(break_it: impl FnOnce(&Path, &mut Value)) -> String {
    let folder = tempfile::tempdir().unwrap();
    written(folder.path());
    let path = folder.path().join("transforms.json");
    let mut transforms = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    break_it(folder.path(), &mut transforms);
    fs::write(&path, transforms.to_string()).unwrap();
    let message = Capture::open(folder.path()).unwrap_err().to_string();
    assert!(!message.contains('\n'), "{message}");
    message
}

#[test]
fn every_fault_of_the_transforms_is_named() {
    let cases = [
        ("/camera_model", json!("FISHEYE"), "\"FISHEYE\"; undistort"),
        ("/camera_model", json!(7), "invalid type"),
        ("/train_filenames", json!([]), "train_filenames is empty"),
        ("/train_filenames/0", json!("images/9.exr"), "no frame has file_path images/9.exr"),
        ("/test_filenames/0", json!("images/000.exr"), "\"000\" is listed twice"),
        ("/frames/1/name", json!("000"), "\"000\" is listed twice"),
        ("/frames/0/name", json!("../000"), "cannot be a file name"),
        ("/frames/0/w", json!(0), "frame images/000.exr: size 0x16 is empty"),
        ("/frames/0/w", json!(17), "000.exr: is 16x16, but its camera says 17x16"),
        ("/frames/0/fl_x", json!(0.0), "fl_x and fl_y must be positive"),
        ("/frames/0/fl_y", json!(-5.0), "fl_x and fl_y must be positive"),
        ("/frames/0/cx", json!("middle"), "invalid type"),
        ("/frames/0/transform_matrix/0/0", json!(2.0), "not rigid"),
        ("/frames/0/transform_matrix/3/0", json!(1.0), "not rigid"),
        ("/frames/0/mask_path", json!("../000.png"), "leads out of the capture folder"),
        ("/frames/0/label_path", json!("/etc/000.png"), "leads out of the capture folder"),
        ("/frames/0/label_path", json!("truth/labels.png"), "part of the truth"),
        ("/frames/0/w", json!(16.5), "frame images/000.exr: w is 16.5; it must be a whole"),
        ("/frames/0/w", json!(1e30), "it must be a whole number of pixels"),
        ("/frames/0/file_path", json!("images/000.JPG"), "no frame has file_path images/000.exr"),
        (
            "/frames/1/transform_matrix",
            json!([[1.0]]),
            "frame images/001.exr: transform_matrix has",
        ),
        ("/frames/1/transform_matrix", json!("x"), "frame images/001.exr: invalid type"),
        ("/label_names", json!({"256": "skin"}), "256"),
        ("/label_names", json!({"0": "skin"}), "label_names: 0"),
        ("/mesh", json!("../mesh.obj"), "mesh: ../mesh.obj leads out"),
    ];
    for (place, value, expected) in cases {
        let message = broken(|_, transforms| *transforms.pointer_mut(place).unwrap() = value);
        assert!(message.contains(expected), "{place}: {message}");
    }
}

#[test]
fn what_nerfstudio_and_instant_ngp_write_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let views = written(folder.path());
    let path = folder.path().join("transforms.json");
    let plain: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    let shared = ["w", "h", "fl_x", "fl_y", "cx", "cy"];
    type Edit = fn(&mut Value);
    let edits: [(&str, Edit); 7] = [
        ("values beside the frames, lists dropped", |_| ()),
        ("sizes as floats", |t| (t["w"], t["h"]) = (json!(16.0), json!(16.0))),
        ("paths with a dot", |t| t["frames"][0]["file_path"] = json!("./images/000.exr")),
        ("paths of Windows", |t| t["frames"][0]["mask_path"] = json!("masks\\000.png")),
        ("no ending", |t| t["frames"][0]["file_path"] = json!("images/000")),
        ("a mask under the picture's name", |t| {
            t["frames"][0].as_object_mut().unwrap().remove("mask_path");
            t.as_object_mut().unwrap().remove("mesh");
        }),
        ("an angle for a focal length", |t| {
            let focal = t["fl_x"].as_f64().unwrap();
            t.as_object_mut().unwrap().retain(|key, _| !["fl_x", "fl_y", "cx"].contains(&&**key));
            t["camera_angle_x"] = json!(2.0 * (8.0 / focal).atan());
        }),
    ];
    for (what, edit) in edits {
        let mut transforms = plain.clone();
        for key in shared {
            transforms[key] = plain["frames"][0][key].clone();
        }
        for frame in transforms["frames"].as_array_mut().unwrap() {
            // The cameras of this rig differ in nothing but their places and focal lengths.
            frame["fl_x"] = transforms_focal(frame);
            frame["fl_y"] = frame["fl_x"].clone();
            let own = |key: &String| !shared.contains(&key.as_str()) || key.starts_with("fl_");
            frame.as_object_mut().unwrap().retain(|key, value| own(key) && !value.is_null());
        }
        let top = transforms.as_object_mut().unwrap();
        top.retain(|key, _| {
            !["camera_model", "train_filenames", "test_filenames"].contains(&&**key)
        });
        edit(&mut transforms);
        let text = format!("\u{feff}{transforms}");
        fs::write(&path, text).unwrap();
        let capture = Capture::open(folder.path()).unwrap_or_else(|e| panic!("{what}: {e}"));
        assert_eq!(capture.train.len(), 3, "{what}");
        assert!(capture.withheld.is_empty());
        assert_eq!(capture.train[1..], views[1..], "{what}");
        assert_eq!(capture.train[0].mask, views[0].mask, "{what}");
        let off = capture.train[0].camera.focal[0] - views[0].camera.focal[0];
        assert!(off.abs() < 1e-4, "{what}: {off}");
    }
}

/// Nothing for the first frame, which takes the value for all.
fn transforms_focal(frame: &Value) -> Value {
    if frame["name"] == "000" { Value::Null } else { frame["fl_x"].clone() }
}

#[test]
fn what_is_missing_is_named_with_its_frame_and_the_fix() {
    let without = |place: &str, key: &str| {
        broken(|_, transforms| {
            transforms.pointer_mut(place).unwrap().as_object_mut().unwrap().remove(key);
        })
    };
    assert!(without("/frames/1", "w").contains("frame images/001.exr: has no w; state w and h"));
    assert!(without("/frames/1", "transform_matrix").contains("frame images/001.exr: missing"));
    assert!(without("/frames/1", "file_path").contains("frame 2 of the list: missing field"));
    let masks = broken(|folder, transforms| {
        fs::remove_file(folder.join("masks/001.png")).unwrap();
        transforms["frames"][1].as_object_mut().unwrap().remove("mask_path");
    });
    assert!(masks.contains("frame images/001.exr: has no mask_path; add a grey PNG"), "{masks}");
    let mesh = broken(|folder, transforms| {
        fs::remove_file(folder.join("mesh.obj")).unwrap();
        transforms.as_object_mut().unwrap().remove("mesh");
    });
    assert!(mesh.contains("names no mesh; add \"mesh\": \"mesh.obj\""), "{mesh}");
    let jpeg = |name: &'static str| {
        broken(move |_, transforms| {
            transforms["frames"][0]["file_path"] = json!(name);
            transforms["train_filenames"][0] = json!(name);
        })
    };
    assert!(jpeg("images/000.JPG").contains("is a JPEG, but pictures are linear float EXR"));
    assert!(jpeg("images/000.JPG").contains("name 000.exr beside it"));
    assert!(
        jpeg("images/009.png")
            .contains("float EXR files; bring the folder in with `unshade import transforms`, or")
    );
}

#[test]
fn every_fault_of_the_files_is_named() {
    type Fault = fn(&Path);
    let cases: [(&str, Fault); 13] = [
        ("mesh.obj: cannot be read", |folder| fs::remove_file(folder.join("mesh.obj")).unwrap()),
        ("000.exr: cannot be read", |folder| {
            fs::remove_file(folder.join("images/000.exr")).unwrap()
        }),
        ("000.png: cannot be read", |folder| {
            fs::remove_file(folder.join("masks/000.png")).unwrap()
        }),
        ("000.png: cannot be read", |folder| {
            fs::write(folder.join("labels/000.png"), "x").unwrap()
        }),
        ("masks/000.png: is 8x16, but its camera says 16x16", |folder| {
            picture::write_png_gray(&folder.join("masks/000.png"), &GrayImage::new(8, 16)).unwrap();
        }),
        ("labels/001.png: is 16x8, but", |folder| {
            picture::write_png_gray(&folder.join("labels/001.png"), &GrayImage::new(16, 8))
                .unwrap();
        }),
        ("every training picture is black", |folder| {
            for name in ["000", "001"] {
                let path = folder.join(format!("images/{name}.exr"));
                picture::write_exr_rgb(&path, &Picture::new(16, 16, 3)).unwrap();
            }
        }),
        ("001.exr: NaN at column 8, row 7, channel G", |folder| {
            let mut image = Picture::new(16, 16, 3);
            image.pixel_mut(8, 7)[1] = f32::NAN;
            picture::write_exr_rgb(&folder.join("images/001.exr"), &image).unwrap();
        }),
        ("has no triangles", |folder| fs::write(folder.join("mesh.obj"), "v 0 0 0\n").unwrap()),
        ("has no texture coordinates", |folder| {
            fs::write(folder.join("mesh.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
        }),
        ("mesh.obj: line 5: names vertex 9, but there are 3", |folder| {
            let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 9/1\n";
            fs::write(folder.join("mesh.obj"), text).unwrap();
        }),
        ("vertex 2 is not finite", |folder| {
            let text = "v 0 0 0\nv NaN 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
            fs::write(folder.join("mesh.obj"), text).unwrap();
        }),
        ("(0, 1.5) is outside the unit square", |folder| {
            let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 0 1.5\nf 1/1 2/2 3/1\n";
            fs::write(folder.join("mesh.obj"), text).unwrap();
        }),
    ];
    for (expected, fault) in cases {
        let message = broken(|folder, _| fault(folder));
        assert!(message.contains(expected), "{expected}: {message}");
    }
    let message = Capture::open(Path::new("/nowhere")).unwrap_err().to_string();
    assert!(message.contains("/nowhere/transforms.json: cannot be read"), "{message}");
}

#[test]
fn pixels_outside_the_mask_may_hold_anything() {
    let folder = tempfile::tempdir().unwrap();
    let views = written(folder.path());
    let mut image = views[0].image.clone();
    let outside = views[0].mask.data.iter().position(|mask| *mask == 0).unwrap();
    image.data[3 * outside] = f32::NAN;
    picture::write_exr_rgb(&folder.path().join("images/000.exr"), &image).unwrap();
    let capture = Capture::open(folder.path()).unwrap();
    assert_eq!(capture.train[0].image.data[3 * outside..3 * outside + 3], [0.0; 3]);
    assert!(capture.train[0].image.data.iter().all(|value| value.is_finite()));
}

#[test]
fn lens_terms_need_a_model_that_has_them() {
    let with = |model: &str, key: &str, value: f64| {
        broken(|_, transforms| {
            transforms["camera_model"] = json!(model);
            transforms["frames"][1][key] = json!(value);
        })
    };
    assert!(with("PINHOLE", "k1", 0.1).contains("camera_model is PINHOLE; state OPENCV"));
    assert!(with("OPENCV", "k3", 0.1).contains("k3 and k4 are not supported"));
    assert!(with("OPENCV", "p1", f64::NAN).contains("invalid type"), "JSON writes NaN as null");
    let beside = broken(|_, transforms| transforms["k1"] = json!(0.1));
    assert!(beside.contains("frame images/000.exr: has lens distortion, but camera"), "{beside}");
    let fisheye = broken(|_, transforms| transforms["is_fisheye"] = json!(true));
    assert!(fisheye.contains("is_fisheye is true; undistort"), "{fisheye}");
}

#[test]
fn lenses_are_taken_out_on_opening() {
    let folder = tempfile::tempdir().unwrap();
    let views = written(folder.path());
    let path = folder.path().join("transforms.json");
    let mut transforms: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    transforms["camera_model"] = json!("OPENCV");
    fs::write(&path, transforms.to_string()).unwrap();
    assert_eq!(Capture::open(folder.path()).unwrap().train, views[..2], "terms left out are zero");
    // The value beside the frames is for those that have none.
    transforms["k1"] = json!(-0.2);
    transforms["frames"][0]["k1"] = json!(0.0);
    fs::write(&path, transforms.to_string()).unwrap();
    let capture = Capture::open(folder.path()).unwrap();
    assert_eq!(capture.train[0], views[0]);
    assert_eq!(capture.train[1].camera, views[1].camera);
    assert_ne!(capture.train[1].image, views[1].image);
    assert_eq!(capture.withheld, [views[2].camera.clone()]);
}

#[test]
fn a_message_is_one_line_whatever_a_name_holds() {
    let frame = json!({ "file_path": "a\nb", "transform_matrix": [] });
    let text = json!({ "frames": [frame] }).to_string();
    let message = Capture::cameras(Path::new("c"), text.as_bytes()).unwrap_err().to_string();
    assert!(
        message.starts_with("c/transforms.json: frame a b") && !message.contains('\n'),
        "{message}"
    );
}
