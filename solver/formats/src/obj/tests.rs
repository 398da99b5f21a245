use super::*;

/// The only object of a file.
fn object(text: &[u8]) -> Object {
    let mut objects = read(text).unwrap();
    assert_eq!(objects.len(), 1, "{objects:?}");
    objects.remove(0)
}

fn reason(text: &str) -> String {
    read(text.as_bytes()).unwrap_err().to_string()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

/// A polygon in the plane, with itself as its chart.
fn polygon(places: &[(f64, f64)]) -> String {
    let mut text = String::new();
    for (x, y) in places {
        text += &format!("v {x} {y} 0\nvt {x} {y}\n");
    }
    let corners: Vec<String> = (1..=places.len()).map(|i| format!("{i}/{i}")).collect();
    text + "f " + &corners.join(" ") + "\n"
}

/// Signed areas of the triangles along +z.
fn areas(object: &Object) -> Vec<f64> {
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| object.positions[corner as usize]);
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
    };
    object.triangles.iter().map(area).collect()
}

#[test]
fn what_editors_and_exporters_write_is_the_same_mesh() {
    let plain = object(format!("{SQUARE}f 1/1 2/2 3/3 4/4\n").as_bytes());
    assert_eq!(plain.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!((plain.name.as_str(), &plain.normals), ("geometry", &None));
    assert_eq!(plain.uvs.as_ref().unwrap()[2], [1.0, 1.0]);
    let face = "f 1/1 2/2 3/3 4/4";
    let written = format!("{SQUARE}{face}\n");
    let variants: Vec<Vec<u8>> = vec![
        [b"\xEF\xBB\xBF".as_slice(), written.as_bytes()].concat(),
        [b"# Gesicht f\xFCr \xE4ltere\n".as_slice(), written.as_bytes()].concat(),
        written.replace('\n', "\r\n").into_bytes(),
        written.replace('\n', "\r").into_bytes(),
        written.replace(' ', "\t").into_bytes(),
        written.replace("\n", "\n    ").into_bytes(),
        written.replace('\n', " # a comment\n").into_bytes(),
        format!("{SQUARE}f 1/1 2/2 \\\n  3/3\\\n4/4\n").into_bytes(),
        format!("# C:\\scans\\\n{SQUARE}mtllib none.mtl\nusemtl\n{face}\nusemtl \\\n").into_bytes(),
        format!("{SQUARE}l 1 2\np 3\nl 1/1 2/2 3/3\n{face}\nf 1 2\n").into_bytes(),
        format!("g a\ns off\n{SQUARE}g b\nusemtl x\n{face}").into_bytes(),
        format!("{face}\n{SQUARE}").into_bytes(),
        format!("{SQUARE}f -4/-4 -3/-3 -2/-2 -1/-1\nv 5 5 5\nvt 0 0\n").into_bytes(),
        SQUARE.replace("1 1 0", "2 2 0 2").replace("1 0 0", "1 0 0 .5 .5 .5").into_bytes(),
    ];
    for mut text in variants {
        if !text.windows(2).any(|pair| pair == b"f " || pair == b"f\t") {
            text.extend_from_slice(face.as_bytes());
        }
        let found = Object { materials: plain.materials.clone(), ..object(&text) };
        assert_eq!(found, plain, "{:?}", String::from_utf8_lossy(&text));
    }
}

#[test]
fn objects_keep_their_names_and_say_where_they_have_no_uv() {
    let text = format!(
        "{SQUARE}o head\nf 1/1 2/2 3/3\no collar  of wool\nf 1 2 3\no head\nf 1/1 3/3 4/4\n"
    );
    let objects = read(text.as_bytes()).unwrap();
    assert_eq!(objects.len(), 2);
    assert_eq!((objects[0].name.as_str(), objects[0].triangles.len()), ("head", 2));
    assert_eq!(objects[0].positions.len(), 4, "shared between its two parts");
    assert_eq!(objects[1].name, "collar  of wool");
    assert_eq!((objects[1].uvs.clone(), objects[1].line_without_uv), (None, Some(12)));
    let latin = read(b"v 0 0 0\no Sch\xE4del\nf 1 1 1\n").unwrap();
    assert_eq!(latin[0].name, "Schädel");
}

#[test]
fn every_triangle_has_its_material() {
    let faces = "f 1/1 2/2 3/3 4/4\nusemtl skin\nf 1/1 2/2 3/3\no eye\nf 1/1 3/3 4/4\nusemtl Grün\n\
        f 1/1 2/2 4/4\nusemtl skin\nf 2/2 3/3 4/4\n";
    let objects = read(format!("{SQUARE}{faces}").as_bytes()).unwrap();
    assert_eq!(
        (objects[0].materials.as_slice(), objects[0].material_of.as_slice()),
        (["", "skin"].map(String::from).as_slice(), [0, 0, 1].as_slice())
    );
    assert_eq!(
        (objects[1].materials.len(), objects[1].material_of.as_slice()),
        (2, [0, 1, 0].as_slice())
    );
}

#[test]
fn polygons_are_cut_without_folds_and_slivers() {
    type Case = (&'static str, &'static [(f64, f64)], usize, f64);
    let cases: [Case; 5] = [
        (
            "U",
            &[(0., 0.), (3., 0.), (3., 3.), (2., 3.), (2., 1.), (1., 1.), (1., 3.), (0., 3.)],
            6,
            7.0,
        ),
        ("arrow", &[(0., 0.), (2., 1.), (0., 2.), (0.5, 1.)], 2, 1.5),
        (
            "points in line",
            &[
                (0., 0.),
                (1., 0.),
                (2., 0.),
                (3., 0.),
                (3., 1.),
                (3., 2.),
                (2., 2.),
                (0., 2.),
                (0., 1.),
            ],
            7,
            6.0,
        ),
        (
            "points in line at a notch",
            &[(0., 0.), (4., 0.), (4., 4.), (3., 3.), (2., 2.), (1., 3.), (0., 4.)],
            5,
            12.0,
        ),
        ("a corner twice", &[(0., 0.), (1., 0.), (1., 0.), (1., 1.), (0., 1.)], 2, 1.0),
    ];
    for (name, places, count, expected) in cases {
        for shift in 0..places.len() {
            let mut places = places.to_vec();
            places.rotate_left(shift);
            let object = object(polygon(&places).as_bytes());
            let areas = areas(&object);
            assert!(areas.iter().all(|area| *area > 1e-3), "{name}, {shift}: {areas:?}");
            assert!((areas.iter().sum::<f64>() - expected).abs() < 1e-9, "{name}: {areas:?}");
            assert_eq!(areas.len(), count, "{name}, {shift}");
        }
    }
}

#[test]
fn a_corner_on_an_edge_of_the_chart_alone_makes_no_sliver_there() {
    // Two bent quadrilaterals as one hexagon, unwrapped as a rectangle.
    let text = "v 0 0 0\nv 1 0 .2\nv 2 0 0\nv 2 1 0\nv 1 1 .2\nv 0 1 0\n\
        vt 0 0\nvt .5 0\nvt 1 0\nvt 1 1\nvt .5 1\nvt 0 1\nf 1/1 2/2 3/3 4/4 5/5 6/6\n";
    let object = object(text.as_bytes());
    let uvs = object.uvs.unwrap();
    let area = |[a, b, c]: [[f64; 2]; 3]| {
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
    };
    let areas: Vec<f64> =
        object.triangles.iter().map(|t| area(t.map(|corner| uvs[corner as usize]))).collect();
    assert!(areas.iter().all(|area| *area > 0.05), "{areas:?}");
    assert!((areas.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    assert_eq!(areas.len(), 4);
}

#[test]
fn convex_faces_are_fans_in_the_files_order() {
    let ring: Vec<(f64, f64)> = (0..50)
        .map(|i| f64::from(i) / 50.0 * std::f64::consts::TAU)
        .map(|a| (a.cos(), a.sin()))
        .collect();
    let object = object(polygon(&ring).as_bytes());
    let fan: Vec<[u32; 3]> = (2..50).map(|i| [0, i - 1, i]).collect();
    assert_eq!(object.triangles, fan);
}

#[test]
fn every_fault_is_named_with_its_line() {
    let cases = [
        ("v 0 0\n", "line 1: a vertex has 3 numbers, but here are 2"),
        ("v 0 0 0\n\nv 0 1,5 0\n", "line 3: \"1,5\" is not a number"),
        ("v 0 0 0 0\n", "line 1: the vertex has weight 0"),
        ("vt 0\n", "line 1: a texture coordinate has 2 numbers"),
        ("vn 1 0 x\n", "line 1: \"x\" is not a number"),
        ("v 0 0 0\n# \\\nf 1 1 9\n", "line 3: names vertex 9, but there are 1"),
        ("v 0 0 0\nf 1 1 -2\n", "line 2: \"-2\" names no vertex; there are 1 so far"),
        ("v 0 0 0\nf 1/4 1/4 1/4\n", "line 2: names texture coordinate 4, but there are 0"),
        ("v 0 0 0\nf 1//7 1//7 1//7\n", "line 2: names normal 7, but there are 0"),
        ("v 0 0 0\nf 0 1 1\n", "line 2: \"0\" names no vertex"),
        ("v 0 0 0\nf 1/0 1 1\n", "line 2: \"1/0\" names no texture coordinate"),
        ("v 0 0 0\nf /1 1 1\n", "line 2: \"/1\" "),
        ("v 0 0 0\nf 1/1/1/1 1 1\n", "line 2: \"1/1/1/1\" "),
        ("v 0 0 0\nf 1 1 \\\n 99999999999999999999\n", "line 2: \"99999999999999999999\" names no"),
        ("v 0 0 0\nf 1 1 -9223372036854775808\n", "names no vertex"),
    ];
    for (text, expected) in cases {
        let found = reason(text);
        assert!(found.contains(expected), "{text:?}: {found}");
    }
    let crossing = polygon(&[(0., 0.), (2., 2.), (2., 0.), (0., 1.5), (-1., 1.), (3., 1.1)]);
    assert!(reason(&crossing).contains("crosses itself; cut it"), "{}", reason(&crossing));
    assert!(read(b"\xFF\xFEv\0 \0").unwrap_err().to_string().contains("UTF-16"));
}

#[test]
fn bytes_of_any_kind_never_panic() {
    use rand::{RngExt, SeedableRng};
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
    let words: [&[u8]; 22] = [
        b"v", b"vt", b"vn", b"f", b"o", b"l", b"usemtl", b" ", b" ", b" ", b"\n", b"\n", b"\t",
        b"\\", b"/", b"-1", b"1", b"2", b"0.5", b"nan", b"1e300", b"\xFF",
    ];
    for _ in 0..20_000 {
        let mut text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\n".to_vec();
        for _ in 0..random.random_range(1..40) {
            text.extend_from_slice(words[random.random_range(0..words.len())]);
        }
        let _ = read(&text);
    }
}
