//! Runs of one suite over the same captures are one run with more methods: solving again what has not
//! changed would cost hours.

use super::finished::Finished;
use super::setting::scene;
use crate::run::Case;
use crate::solve::plain;

/// Sets runs side by side that can be; the others stay on their own, in the order given.
pub(super) fn joined(runs: Vec<Finished>) -> Vec<Finished> {
    let mut kept: Vec<Finished> = Vec::new();
    for run in runs {
        match kept.iter_mut().find(|other| same_captures(other, &run)) {
            Some(other) => join(other, run),
            None => kept.push(run),
        }
    }
    kept
}

/// Returns whether both ran one suite, case for case on captures of the same scene, with other methods.
fn same_captures(a: &Finished, b: &Finished) -> bool {
    let scene = |run: &Finished, case: &Case| scene(&run.folder.join(&case.capture));
    let methods = |case: &Case| -> Vec<String> {
        case.methods.iter().map(|method| method.id.clone()).collect()
    };
    a.manifest.suite == b.manifest.suite
        && a.manifest.cases.len() == b.manifest.cases.len()
        && a.manifest.cases.iter().zip(&b.manifest.cases).all(|(one, other)| {
            one.id == other.id
                && !scene(a, one).is_empty()
                && scene(a, one) == scene(b, other)
                && methods(one).iter().all(|id| !methods(other).contains(id))
        })
}

fn join(run: &mut Finished, other: Finished) {
    let mut added: Vec<String> = Vec::new();
    for (at, mut case) in other.manifest.cases.into_iter().enumerate() {
        for method in &mut case.methods {
            // Absolute, since the joined run is in another folder.
            method.maps = method.maps.take().map(|maps| other.folder.join(maps));
            let title = method.title().to_owned();
            if !added.contains(&title) {
                added.push(title);
            }
        }
        run.manifest.cases[at].methods.extend(case.methods);
    }
    for (scores, more) in run.scores.iter_mut().zip(other.scores) {
        scores.extend(more);
    }
    for (name, version) in other.manifest.versions {
        // Another renderer's build is another machine, not another result.
        let same = run.manifest.versions.get(&name).map(plain) == Some(plain(&version));
        if !same && name != "renderer" {
            run.manifest.versions.insert(format!("{name} of {}", added.join(" and ")), version);
        }
    }
}
