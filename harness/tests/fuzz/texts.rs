//! Small texts of all the kinds that the readers know, and the words of each.

use std::path::Path;

/// Words of JSON files, between bars.
pub const JSON: &str = "{|}|[|]|,|:|\"|\\|null|true|false|\\u0000|\\ud800|\"\"|\"a\"|{}|[]|\u{FEFF}|é|..|/|\
    truth|w|h|k1|k3|OPENCV|camera_angle_x|is_fisheye|applied_transform|name|format";
/// Words of TOML files, between bars.
pub const TOML: &str = "[|]|[[|]]|=|\n|\"|\"\"\"|'|'''|.|,|{|}|#|\\|true|1979-05-27T07:32:00Z|0x7f|1_0|\
    method|variant|name|format|render|faces|lights|face|light|command|python|config|set|\
    base|threads|timeout_s|memory_gib|inputs|version|oracle|mean_texture|fast|face.toml|\
    scene.toml|suite.toml|é|\u{FEFF}";
/// Words of OBJ files, between bars.
pub const OBJ: &str = "v |vt |vn |f |o |g |l |p |s off|usemtl|\n|\r|\t| |\\\n|/|//|-1|-4|1/1/1|2/2|3//3|# |\
    \u{FEFF}|é|1.5.5";

/// OBJ files: with normals, without, polygons, negative indices, several objects.
pub fn obj() -> Vec<Vec<u8>> {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    let mut cube = String::from("mtllib a.mtl\no cube\n");
    for corner in 0..8 {
        cube += &format!("v {} {} {}\n", corner & 1, corner >> 1 & 1, corner >> 2);
        cube += &format!("vt {} {}\n", corner & 1, corner >> 1 & 1);
        cube += "vn 0 0 1\n";
    }
    for [a, b, c, d] in [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3]] {
        cube += &format!("f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c} {d}/{d}/{d}\n");
    }
    let star: String = (0..10)
        .map(|corner| {
            let (angle, radius) = (f64::from(corner) * 0.628, 0.2 + f64::from(corner % 2) * 0.3);
            let (x, y) = (0.5 + radius * angle.cos(), 0.5 + radius * angle.sin());
            format!("v {x:.3} {y:.3} 0\nvt {x:.3} {y:.3}\n")
        })
        .collect();
    let ring: Vec<String> = (1..=10).map(|corner| format!("{corner}/{corner}")).collect();
    let texts = [
        format!("{square}f 1/1 2/2 3/3 4/4\n"),
        format!("{square}f -4/-4 -3/-3 \\\n -2/-2 -1/-1 # comment\n"),
        format!("{square}vn 0 0 1\no a\nf 1/1/1 2/2/1 3/3/1\no b\nf 1/1/1 3/3/1 4/4/1\n"),
        cube,
        format!("{star}f {}\n", ring.join(" ")),
    ];
    texts.map(String::into_bytes).to_vec()
}

/// `transforms.json` with shared and own intrinsics, lenses, lists of frames.
pub fn transforms() -> Vec<Vec<u8>> {
    let matrix = "[[1,0,0,0.5],[0,1,0,0],[0,0,1,2],[0,0,0,1]]";
    let plain = format!(
        "{{\"w\": 16, \"h\": 8, \"fl_x\": 20.5, \"fl_y\": 20, \"cx\": 8, \"cy\": 4, \"mesh\": \"mesh.obj\",\n\
         \"frames\": [{{\"file_path\": \"images/a.exr\", \"mask_path\": \"masks/a.png\", \
         \"transform_matrix\": {matrix}}}, {{\"file_path\": \"./images/b\", \"name\": \"b\", \
         \"mask_path\": \"masks/b.png\", \"label_path\": \"labels/b.png\", \"w\": 32, \
         \"transform_matrix\": {matrix}}}],\n\"train_filenames\": [\"images/a.exr\"], \
         \"test_filenames\": [\"images/b.exr\"], \"label_names\": {{\"1\": \"skin\", \"2\": \"eyes\"}}}}"
    );
    let lens = format!(
        "{{\"camera_model\": \"OPENCV\", \"camera_angle_x\": 0.8, \"w\": 16.0, \"h\": 8.0, \"k1\": 0.1, \
         \"k2\": -0.01, \"p1\": 0, \"p2\": 1e-3, \"mesh\": \"mesh.obj\", \
         \"applied_transform\": [[1,0,0,0],[0,0,1,0],[0,-1,0,0]], \"frames\": [{{\"file_path\": \
         \"images\\\\a.exr\", \"mask_path\": \"masks/a.png\", \"transform_matrix\": {matrix}}}]}}"
    );
    vec![plain.into_bytes(), lens.into_bytes()]
}

/// Writes a scene and what it names, and returns suites of it.
pub fn suites(folder: &Path) -> Vec<Vec<u8>> {
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    write("face.toml", "name = \"ada\"\nseed = 3\n");
    write("key.toml", "name = \"key\"\nkind = \"studio\"\n");
    write("hall.toml", "name = \"hall\"\nkind = \"envmap\"\npath = \"hall.exr\"\n");
    write("scene.toml", SCENE);
    let plain = "format = 1\nname = \"m\"\ntitle = \"A suite\"\nscene = \"scene.toml\"\n\
        lights = [\"key.toml\", \"hall.toml\"]\nfaces = [\"face.toml\"]\nscales = [\"none\"]\n\
        [render]\nwidth = 16\n[face]\ntexture_size = 64\n[[variant]]\nname = \"no labels\"\n\
        [variant.labels]\nomit = true\n[[method]]\nname = \"fast\"\nbackend = \"cpu\"\n\
        set = { seed = 4 }\n[[method]]\nname = \"mine\"\ncommand = \"run {capture} {maps}\"\n\
        timeout_s = 4.5\nmemory_gib = 2\nthreads = 2\nversion = \"1\"\ninputs = [\"a\"]\n\
        environment = { A = \"b\" }\n[[method]]\nname = \"mean_texture\"\ntexture_size = 16\n";
    let short = "format = 1\nname = \"m\"\nscene = \"scene.toml\"\n[[method]]\nname = \"oracle\"\n\
        [[method]]\nname = \"own\"\npython = \"method:solve\"\n";
    [plain, short, SCENE].map(|text| text.as_bytes().to_vec()).to_vec()
}

const SCENE: &str = "format = 1\nname = \"s\"\nface = \"face.toml\"\nlight = \"key.toml\"\n\
    relight = [\"hall.toml\"]\nrig = { name = \"r\", kind = \"phone\" }\n\
    [render]\nwidth = 8\nheight = 8\n[captured_mesh]\ndetail = 0.5\n";

/// `scores.json`, with findings and without.
pub fn scores() -> Vec<Vec<u8>> {
    let row = |subject: &str, metric: &str, rest: &str| {
        format!(
            "{{\"subject\": \"{subject}\", \"metric\": \"{metric}\", \"scale\": \"global\", \
             \"region\": \"coverage-e5\", {rest}}}"
        )
    };
    let rows = [
        row(
            "diffuse_albedo",
            "psnr_srgb",
            "\"label\": null, \"light\": null, \"value\": 30.25, \"ci95\": [29.5, 31], \"n\": 1024, \
             \"floor\": 41.5",
        ),
        row(
            "relit",
            "ssim",
            "\"label\": \"skin\", \"light\": \"hall\", \"value\": null, \"ci95\": null, \"n\": 0, \
             \"floor\": null, \"per_frame\": {\"010\": 0.5, \"011\": 1e-9}",
        ),
    ];
    let text = |findings: &str| {
        format!(
            "{{\"format\": 1, \"capture\": \"c\", \"face\": \"ada\", \"light\": \"key\", \"solver\": \"fast\",\n\
             \"protocol\": {{\"id\": \"unshade-1\", \"statements\": [\"a\", \"b\"]}},\n\
             \"inputs\": {{\"capture\": \"00\", \"maps\": \"01\", \"relit\": null}},\n\
             \"scale\": {{\"global\": 1.5, \"channel\": [1, 2, 3], \"median\": [1, 1, 0.5]}},\n\
             \"regions\": [{{\"region\": \"mask-e5/010\", \"pixels\": 64, \"share\": 0.5, \
             \"solved\": null}}],{findings}\n\"rows\": [{}]}}",
            rows.join(",\n")
        )
    };
    let findings = "\"findings\": [{\"id\": \"flipped-v\", \"level\": \"warning\", \"map\": \"a.exr\", \
        \"message\": \"m\", \"fix\": \"n\", \"evidence\": {\"overlap\": 0.5}}],";
    vec![text("").into_bytes(), text(findings).into_bytes()]
}

/// `baseline.json`.
pub fn baselines() -> Vec<Vec<u8>> {
    let text = "{\"format\": 1, \"suite\": \"tiny\", \"versions\": {\"unshade\": \"0.1.0\", \"n\": {\"a\": [1]}},\n\
        \"rows\": {\n\
        \"ada-key/fast/diffuse_albedo/psnr_srgb@coverage-e5:global\": {\"value\": 30.25, \"ci95\": [29, 31], \"n\": 64},\n\
        \"ada-key/fast/relit/hall/ssim@mask-e5:none\": {\"value\": 0.5, \"ci95\": null, \"n\": 64},\n\
        \"ada-key/fast/view/flip_mean@mask-e5.skin:none\": {\"value\": null, \"ci95\": null, \"n\": 0}}}";
    vec![text.as_bytes().to_vec()]
}
