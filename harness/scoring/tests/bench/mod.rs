//! A capture to score, and what its tests write beside it. Not every file of tests uses all of it.

#![allow(dead_code)]

use std::fs;
use std::path::{Path, PathBuf};

use formats::picture::Picture;
use scoring::score::{Scores, score};

use crate::plane::{SIDE, map, write_capture, write_rgb};

/// A capture in a folder of its own.
pub struct Bench {
    pub root: tempfile::TempDir,
}

impl Bench {
    pub fn new(variance: f64) -> Self {
        let bench = Self { root: tempfile::tempdir().unwrap() };
        write_capture(&bench.capture(), variance);
        bench
    }

    pub fn capture(&self) -> PathBuf {
        self.root.path().join("capture")
    }

    /// A maps folder with one map only.
    pub fn albedo_maps(&self, side: usize, texture: impl Fn(f64, f64) -> [f64; 3]) -> PathBuf {
        let maps = self.root.path().join("maps");
        fs::create_dir_all(&maps).unwrap();
        write_rgb(&maps.join("diffuse_albedo.exr"), &map(side, 3, texture));
        maps
    }

    pub fn score_albedo(&self, texture: impl Fn(f64, f64) -> [f64; 3]) -> Scores {
        score(&self.capture(), &self.albedo_maps(SIDE, texture), None).unwrap()
    }

    pub fn refused(&self, maps: &Path, relit: Option<&Path>) -> String {
        let error = score(&self.capture(), maps, relit).unwrap_err().to_string();
        assert!(!error.contains('\n'), "{error}");
        error
    }
}

/// The value of a row that is there.
pub fn value(scores: &Scores, id: &str) -> f64 {
    scores.row(id).unwrap_or_else(|| panic!("no row {id}")).value.unwrap()
}

/// A true light with two lamps, and one that was found: half as bright, the lamps a cell aside.
pub fn write_lights(capture: &Path, maps: &Path) {
    let lit = |width: usize, height: usize, lamps: [(f64, f64); 2], level: f32| {
        let mut light = Picture {
            data: vec![0.1 * level; 3 * width * height],
            ..Picture::new(width, height, 3)
        };
        for (u, v) in lamps {
            light
                .pixel_mut((u * width as f64) as usize, (v * height as f64) as usize)
                .fill(90.0 * level);
        }
        light
    };
    let truth = lit(64, 33, [(0.4, 0.3), (0.7, 0.45)], 1.0);
    write_rgb(&capture.join("truth/light.exr"), &truth);
    write_rgb(&maps.join("light.exr"), &lit(64, 32, [(0.4 + 1.0 / 64.0, 0.3), (0.7, 0.45)], 0.5));
}
