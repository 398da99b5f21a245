use std::fs;
use std::path::Path;

use super::{ReportError, fake, write};

fn report() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let (run, out) = (folder.path().join("run"), folder.path().join("report"));
    fake::write(&run);
    write(&run, &out).unwrap();
    let html = fs::read_to_string(out.join("index.html")).unwrap();
    (folder, html)
}

fn between<'a>(text: &'a str, from: &str, to: &str) -> Vec<&'a str> {
    text.split(from).skip(1).map(|rest| rest.split(to).next().unwrap()).collect()
}

#[test]
fn scratch_report() {
    if let Ok(out) = std::env::var("SCRATCH_REPORT") {
        let run = Path::new(&out).join("run");
        fake::write(&run);
        println!("{:?}", write(&run, &Path::new(&out).join("report")).unwrap());
    }
}

#[test]
fn every_row_states_its_protocol() {
    let (_folder, html) = report();
    let rows = between(&html, "<tr title=\"", "</tr>");
    assert!(rows.len() > 20, "{}", rows.len());
    for row in rows {
        let protocol = between(row, "<td class=\"protocol\">", "</td>");
        assert_eq!(protocol.len(), 1);
        let parts: Vec<&str> = protocol[0].split("; ").collect();
        assert!(parts.len() == 3 && parts.iter().all(|part| !part.is_empty()), "{protocol:?}");
    }
}
