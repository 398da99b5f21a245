//! Whole solves of a small scene.

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use solver::backend::Backend;
use solver::backend::cpu::Cpu;
use solver::{Config, Options, Solution, solve_into, solve_on};

use super::scene::{capture, short, short_paper};

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
    near_the_processor(backend, &short());
    near_the_processor(backend, &Config::Paper(short_paper()));
}

fn near_the_processor(backend: &dyn Backend, config: &Config) {
    let reference = solve(&Cpu::new(), config);
    let other = |seed: u64| {
        let text = format!("seed = {seed}\n{}", config.to_toml().replacen("seed = 0\n", "", 1));
        solve(&Cpu::new(), &Config::from_toml(&text).unwrap())
    };
    let spreads = [7, 14, 21, 28].map(|seed| distance(&other(seed), &reference));
    let found = solve(backend, config);
    assert_eq!(found.record.backend, backend.name());
    let (off, spread) = (distance(&found, &reference), spreads.into_iter().fold(0.0, f64::max));
    println!("albedo: {off:.6} from the processor's, which moves by {spreads:.6?} with the seed");
    assert!(off < spread, "{off} {spread}");
}

/// Files of the maps and the record, without wall times.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let kept = entries.filter(|path| path.is_file() && !path.ends_with("timing.json"));
    let mut files: Vec<_> = kept
        .map(|path| (path.strip_prefix(folder).unwrap().to_owned(), fs::read(path).unwrap()))
        .collect();
    files.sort();
    files
}

pub fn resumed(backend: &dyn Backend) {
    let folder = tempfile::tempdir().unwrap();
    let capture = capture(&folder.path().join("capture"));
    let (whole, maps) = (folder.path().join("whole"), folder.path().join("maps"));
    let solve = |maps: &Path, stop: usize| {
        let mut first = None;
        let hear = &mut |progress: &solver::Progress| {
            first.get_or_insert(progress.iteration);
            if progress.iteration >= stop {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let solution = solve_into(backend, maps, "tests", &capture, &short(), hear).unwrap();
        (solution.record.interrupted, first)
    };
    assert_eq!(solve(&whole, usize::MAX).0, None);
    // In both rounds of the light, the joint fit and the relief.
    for stop in [40, 90, 200, 250] {
        let (place, first) = solve(&maps, stop);
        assert!(place.is_some(), "{stop}");
        assert!(first > Some(1) || stop == 40, "{stop}: begun anew at {first:?}");
        // An interrupt comes at the end of a submission.
        let written: usize = place.unwrap().split(' ').rev().nth(2).unwrap().parse().unwrap();
        assert!(written > 0, "{stop}");
    }
    assert_eq!(solve(&maps, usize::MAX).0, None);
    assert!(files(&maps) == files(&whole), "other bytes");
}
