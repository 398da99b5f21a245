//! A dome with labelled regions, for tests of both methods.

use std::ops::ControlFlow;
use std::path::Path;

use capture::{Capture, View};
use glam::Vec3;

use crate::backend::cpu::Cpu;
use crate::run::progress::Callback;
use crate::{Config, Options, Solution, SolveError, solve_on, testing};

/// Labelled regions of the dome with their reflectance.
pub const REGIONS: [(u8, Vec3); 3] = [
    (1, Vec3::new(0.6, 0.4, 0.3)),
    (2, Vec3::new(0.45, 0.25, 0.22)),
    (3, Vec3::new(0.2, 0.15, 0.12)),
];

pub fn region(position: Vec3) -> (u8, Vec3) {
    REGIONS[match (position.truncate().length(), position.x) {
        (radius, _) if radius < 0.3 => 1,
        (_, x) if x < -0.45 => 2,
        _ => 0,
    }]
}

/// The unit dome under one soft light from the upper right; its largest irradiance is pi.
fn lit(position: Vec3) -> (Vec3, u8) {
    let (label, albedo) = region(position);
    let light = Vec3::new(0.4, 0.5, 0.77).normalize();
    (albedo * (0.25 + 0.75 * position.dot(light).max(0.0)), label)
}

pub fn views(count: usize, size: usize) -> Vec<View> {
    let mesh = testing::dome(24);
    testing::rig(count, size).iter().map(|camera| testing::view(&mesh, camera, lit)).collect()
}

/// A capture folder with five training views and one withheld.
pub fn capture(folder: &Path) -> Capture {
    testing::write_capture(folder, &testing::dome(24), &views(6, 48), 1);
    Capture::open(folder).unwrap()
}

/// Solves on the processor.
pub fn solve(
    capture: &Capture,
    config: &Config,
    progress: &mut Callback,
) -> Result<Solution, SolveError> {
    solve_on(&Cpu::new(), capture, config, Options::default(), progress)
}

/// A progress callback that continues.
pub fn silent(_: &crate::Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
