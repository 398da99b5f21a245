//! Whole solves of a small scene.

use std::ops::ControlFlow;

use solver::backend::Backend;
use solver::backend::cpu::Cpu;
use solver::{Config, Options, Solution, solve_on};

use super::scene::{capture, short};

fn solve(backend: &dyn Backend, config: &Config) -> Solution {
    let folder = tempfile::tempdir().unwrap();
    let capture = capture(folder.path());
    let silent = &mut |_: &solver::Progress| ControlFlow::Continue(());
    solve_on(backend, &capture, config, Options::default(), silent).unwrap()
}

/// Root mean square of the difference of the seen albedos.
fn distance(a: &Solution, b: &Solution) -> f64 {
    let maps = [a, b].map(|solution| &solution.maps);
    let [a, b] = maps.map(|maps| maps.diffuse_albedo.as_ref().unwrap());
    let seen = &maps[0].coverage.as_ref().unwrap().data;
    let texels = a.data.chunks_exact(3).zip(b.data.chunks_exact(3)).zip(seen);
    let seen: Vec<_> = texels.filter(|(_, seen)| **seen > 0).map(|(pair, _)| pair).collect();
    let square = |(a, b): &(&[f32], &[f32])| -> f64 {
        a.iter().zip(*b).map(|(a, b)| f64::from(a - b).powi(2)).sum()
    };
    (seen.iter().map(square).sum::<f64>() / (3 * seen.len()) as f64).sqrt()
}

pub fn whole(backend: &dyn Backend) {
    let config = short();
    let reference = solve(&Cpu::new(), &config);
    let other = |seed: u64| solve(&Cpu::new(), &Config { seed, ..config.clone() });
    let spreads = [7, 14, 21, 28].map(|seed| distance(&other(seed), &reference));
    let found = solve(backend, &config);
    assert_eq!(found.record.backend, backend.name());
    let (off, spread) = (distance(&found, &reference), spreads.into_iter().fold(0.0, f64::max));
    println!("albedo: {off:.6} from the processor's, which moves by {spreads:.6?} with the seed");
    assert!(off < spread, "{off} {spread}");
}
