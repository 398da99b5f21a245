//! One set of tests for every backend: the processor at each of its instruction sets, and a GPU.
//!
//! The GPU is the one that `UNSHADE_ADAPTER` names, else a software adapter, else any adapter. Without an adapter, its
//! tests are skipped by name.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod heights;
mod kernels;
mod lost;
mod model;
mod scene;
mod sizes;
mod solves;
mod stages;
#[allow(dead_code, reason = "shared with the unit tests, which need more of it")]
#[path = "../../capture/src/testing.rs"]
mod testing;
mod textured;

use std::sync::LazyLock;

use libtest_mimic::{Arguments, Failed, Trial};

use solver::backend::cpu::{Cpu, Level};
use solver::backend::gpu::{Adapter, Gpu, VARIABLE, adapters};
use solver::backend::{Backend, Choice};

/// A test's body: on a backend, against the processor where it needs a reference.
type Body = fn(&dyn Backend);
/// The body of a test that opens its own device.
type OnAdapter = fn(&Adapter);

/// Tests of every backend.
const SHARED: [(&str, Body); 6] = [
    ("joint gradients match central differences", kernels::joint_gradients),
    ("direction gradients match central differences", kernels::direction_gradients),
    ("shading matches the reference and the other backends", kernels::shading),
    ("so many samples are what each of them is", sizes::samples),
    ("the warm-up in one pass is that through planes", textured::joint),
    ("deviated normals in one pass is that through planes", textured::normals),
];

/// Tests of backends that run whole fits.
const RESIDENT: [(&str, Body); 7] = [
    ("50 steps of the warm-up are the processor's", stages::warm_up),
    ("50 steps of the diffuse stage are the processor's", stages::diffuse),
    ("50 steps of normals and specular albedo are the processor's", stages::normals),
    ("highlights on bent normals are the processor's", stages::skin_highlights),
    ("12 steps of the height solve are those written out", heights::conjugate_gradients),
    ("a solve is as near to the processor's as another seed's", solves::whole),
    ("an interrupted solve goes on to the same bytes", solves::resumed),
];

/// Tests of devices that are opened for the test.
const OWN: [(&str, OnAdapter); 6] = [
    ("no choice but a name leads to a software adapter", choice),
    ("every pass is timed, and has the same result", stages::timed),
    ("multiply-adds and bandwidth are measured", stages::ceilings),
    ("a device lost within a stage leaves it to the processor", lost::within_a_stage),
    ("a device lost within the height solve leaves it to the processor", lost::within_the_heights),
    ("a device lost before everything leaves everything to the processor", lost::before),
];

/// The adapter of the GPU's tests.
static ADAPTER: LazyLock<Option<Adapter>> = LazyLock::new(|| match std::env::var(VARIABLE) {
    // An interpreter has no drivers.
    _ if cfg!(miri) => None,
    Ok(_) => Some(Adapter::chosen().unwrap()),
    Err(_) => {
        let all = adapters();
        all.iter().find(|adapter| adapter.software).or(all.first()).cloned()
    }
});

/// Opened once, since its kernels take seconds to compile.
static GPU: LazyLock<Option<Gpu>> = LazyLock::new(|| {
    ADAPTER.as_ref().map(|adapter| Gpu::open(adapter).unwrap().in_pieces(PIECE, AXIS))
});

/// Samples of a piece: the tests have a few thousand, in several pieces.
const PIECE: usize = 1024;
/// Workgroups along one axis: nearly every grid has two, most of them with workgroups too many.
const AXIS: usize = 3;

fn main() {
    let mut arguments = Arguments::from_args();
    // One device, two cores: trials next to each other would only wait.
    arguments.test_threads.get_or_insert(1);
    let mut trials = vec![];
    for level in Level::available() {
        for (name, body) in SHARED {
            let run = move || passed(&Cpu::at(level), body);
            trials.push(Trial::test(format!("{}: {name}", Cpu::at(level).name()), run));
        }
    }
    trials.push(Trial::test("textures of a few texels are those written out", || {
        sizes::textures();
        Ok(())
    }));
    trials.push(Trial::test(
        "steps of the normals are the same on all threads and after a stop",
        || {
            textured::steps();
            Ok(())
        },
    ));
    let gpu = match &*ADAPTER {
        Some(adapter) => format!("gpu ({}, {}, {})", adapter.name, adapter.api, adapter.driver),
        None => "gpu (no adapter)".to_owned(),
    };
    for (name, body) in SHARED.into_iter().chain(RESIDENT) {
        let run = move || passed(GPU.as_ref().unwrap(), body);
        trials.push(Trial::test(format!("{gpu}: {name}"), run));
    }
    for (name, body) in OWN {
        let run = move || {
            body(ADAPTER.as_ref().unwrap());
            Ok(())
        };
        trials.push(Trial::test(format!("{gpu}: {name}"), run));
    }
    if ADAPTER.is_none() {
        let skip = |trial: Trial| match trial.name().starts_with("gpu") {
            true => trial.with_ignored_flag(true),
            false => trial,
        };
        trials = trials.into_iter().map(skip).collect();
    }
    // The terse format names neither the adapter nor what is skipped.
    if !arguments.list {
        for trial in trials.iter().filter(|trial| trial.name().starts_with("gpu")) {
            let what = if trial.has_ignored_flag() { "skipped" } else { "to run" };
            println!("{what}: {}", trial.name());
        }
    }
    libtest_mimic::run(&arguments, trials).exit();
}

fn choice(adapter: &Adapter) {
    let named = std::env::var(VARIABLE).is_ok();
    let real = adapters().iter().any(|adapter| !adapter.software);
    let auto = Choice::Auto.open().unwrap().name();
    assert_eq!(auto.starts_with("gpu, "), if named { !adapter.software } else { real }, "{auto}");
    match Choice::Gpu.open() {
        Ok(gpu) => assert!((named || real) && gpu.name().starts_with("gpu, "), "{}", gpu.name()),
        Err(error) => {
            let line = error.to_string();
            assert!(!named && !real && line.contains(&adapter.name), "{line}");
            assert!(line.starts_with("no GPU was found") && !line.contains('\n'), "{line}");
        }
    }
    assert!(Choice::Cpu.open().unwrap().name().starts_with("cpu, "));
}

/// A test fails if its device failed, even if the processor continued.
fn passed(backend: &dyn Backend, body: Body) -> Result<(), Failed> {
    let name = backend.name();
    body(backend);
    if backend.name() == name { Ok(()) } else { Err(backend.name().into()) }
}
