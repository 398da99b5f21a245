use std::ops::ControlFlow;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let capture = solver::Capture::open(a[1].as_ref()).unwrap();
    let text = std::fs::read_to_string(&a[3]).unwrap_or_else(|_| format!("base = \"{}\"", a[3]));
    let config = solver::Config::from_toml(&text).unwrap();
    let _ = std::fs::remove_dir_all(&a[2]);
    let s = solver::solve(&capture, &config, &mut |_| ControlFlow::Continue(())).unwrap();
    eprintln!("S pct distance {:?} scale {} ", s.light.as_ref().map(|l| l.distance), s.record.diffuse_scale);
    s.write(a[2].as_ref()).unwrap();
}
