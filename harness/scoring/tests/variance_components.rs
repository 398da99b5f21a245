//! Components of variance and the bias between groups of skin tone, of scores that are made of known parts.

#![allow(clippy::unwrap_used)]

use std::f64::consts::SQRT_2;

use scoring::score::Row;
use scoring::study::{Observation, Study};

/// What a score gains by the second face, light, view, seed of the renderer and seed of the solver.
const FACE: f64 = 4.0;
const LIGHT: f64 = 1.5;
const VIEW: f64 = 0.8;
const RENDER: f64 = 0.4;
const SOLVER: f64 = 0.1;

fn observation([face, light, render, solver]: [usize; 4]) -> Observation {
    let gains = [FACE, LIGHT, RENDER, SOLVER];
    let seconds = [face, light, render, solver].map(|at| at as f64);
    let value = 30.0 + gains.iter().zip(seconds).map(|(gain, at)| gain * at).sum::<f64>();
    let views = [("010", value - VIEW / 2.0), ("011", value + VIEW / 2.0)];
    let name = |what: &str, at: usize| format!("{what}{at}");
    Observation {
        suite: "made".to_owned(),
        case: format!("{face}-{light}-{render}"),
        face: name("face", face),
        // Very light and dark skin.
        skin_tone: Some([60.0, -40.0][face]),
        light: name("light", light),
        variant: None,
        seed: Some(render as u64),
        method: "own".to_owned(),
        method_seed: Some(solver as u64),
        kind: "solver".to_owned(),
        class: "passive".to_owned(),
        row: Row {
            subject: "relit".to_owned(),
            metric: "psnr_srgb".to_owned(),
            scale: "global".to_owned(),
            region: "mask-e5".to_owned(),
            label: None,
            light: Some(name("light", light)),
            value: Some(value),
            ci95: None,
            block: None,
            n: 100,
            floor: None,
            per_frame: views.into_iter().map(|(view, value)| (view.to_owned(), value)).collect(),
        },
    }
}

#[test]
fn every_component_is_the_spread_of_what_it_is_made_of() {
    let both = || (0..2_usize).flat_map(|a| (0..2_usize).map(move |b| [a, b]));
    let places = both().flat_map(|[a, b]| both().map(move |[c, d]| [a, b, c, d]));
    let study = Study::of(&places.map(observation).collect::<Vec<_>>());
    let [found] = &study.components[..] else { panic!("{:?}", study.components) };
    // The standard deviation of two values is their difference over the root of two.
    for (name, found, gain) in [
        ("faces", found.faces, FACE),
        ("lights", found.lights, LIGHT),
        ("views", found.views, VIEW),
        ("seeds of the renderer", found.render_seeds, RENDER),
        ("seeds of the solver", found.solver_seeds, SOLVER),
    ] {
        assert!((found.unwrap() - gain / SQRT_2).abs() < 1e-9, "{name}: {found:?}");
    }
    let [found] = &study.fairness[..] else { panic!("{:?}", study.fairness) };
    assert_eq!((found.worst, found.groups.len()), (Some("very light"), 2));
    assert!((found.gap.unwrap() - FACE).abs() < 1e-9);
    // Of the groups' means, whose number is known, the population's.
    assert!((found.bias.unwrap() - FACE / 2.0).abs() < 1e-9);
}
