//! The extension module `unshade._native`: bindings, nothing else.

mod arrays;
mod bookkeeping;
mod calls;
mod capture;
mod cluster;
mod errors;
mod folders;
mod gpu_of_process;
mod maps;
mod meshes;
mod metrics;
mod pictures;
mod skin;
mod stages;
mod tangents;
mod threads;

use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Functions and classes behind the Python package `unshade`.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let package = module.py().import("unshade")?.filename()?.extract::<std::path::PathBuf>()?;
    harness::suite::set_scenes_folder(package.with_file_name("scenes"));
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    let sources = PyDict::new(module.py());
    sources.set_item("readers", harness::suite::READER_SOURCES)?;
    sources.set_item("capture", harness::suite::CAPTURE_SOURCES)?;
    let all = [harness::suite::SOLVER_SOURCES, harness::suite::SCORE_SOURCES].concat();
    sources.set_item("all", all)?;
    module.add("sources", sources)?;
    module.add("subjects", report::subjects().collect::<Vec<_>>())?;
    module.add_class::<capture::Capture>()?;
    module.add_function(wrap_pyfunction!(maps::read_maps, module)?)?;
    module.add_function(wrap_pyfunction!(maps::write_maps, module)?)?;
    module.add_function(wrap_pyfunction!(maps::map_array, module)?)?;
    module.add_function(wrap_pyfunction!(maps::coverage_array, module)?)?;
    module.add_function(wrap_pyfunction!(bookkeeping::figure, module)?)?;
    module.add_function(wrap_pyfunction!(bookkeeping::table, module)?)?;
    module.add_function(wrap_pyfunction!(bookkeeping::site, module)?)?;
    module.add_function(wrap_pyfunction!(bookkeeping::seal, module)?)?;
    module.add_function(wrap_pyfunction!(bookkeeping::score_submission, module)?)?;
    module.add_function(wrap_pyfunction!(bookkeeping::verify, module)?)?;
    module.add_function(wrap_pyfunction!(bookkeeping::calibrate, module)?)?;
    module.add_function(wrap_pyfunction!(calls::run_command_line, module)?)?;
    module.add_function(wrap_pyfunction!(calls::solve, module)?)?;
    module.add_function(wrap_pyfunction!(calls::score_json, module)?)?;
    module.add_function(wrap_pyfunction!(calls::shown_json, module)?)?;
    module.add_function(wrap_pyfunction!(calls::judged_rows_json, module)?)?;
    module.add_function(wrap_pyfunction!(calls::study_json, module)?)?;
    module.add_function(wrap_pyfunction!(calls::check_json, module)?)?;
    module.add_function(wrap_pyfunction!(calls::compare, module)?)?;
    module.add_function(wrap_pyfunction!(calls::read_scores, module)?)?;
    module.add_function(wrap_pyfunction!(calls::write_scores, module)?)?;
    module.add_function(wrap_pyfunction!(stages::synth, module)?)?;
    module.add_function(wrap_pyfunction!(stages::relight, module)?)?;
    module.add_function(wrap_pyfunction!(stages::budget, module)?)?;
    module.add_function(wrap_pyfunction!(stages::run, module)?)?;
    module.add_function(wrap_pyfunction!(folders::begin_folder, module)?)?;
    module.add_function(wrap_pyfunction!(folders::commit_folder, module)?)?;
    module.add_function(wrap_pyfunction!(stages::report, module)?)?;
    module.add_function(wrap_pyfunction!(metrics::metric_definitions, module)?)?;
    module.add_function(wrap_pyfunction!(metrics::measure, module)?)?;
    module.add_function(wrap_pyfunction!(metrics::shown, module)?)?;
    module.add_function(wrap_pyfunction!(meshes::read_obj, module)?)?;
    module.add_function(wrap_pyfunction!(meshes::examine_layout, module)?)?;
    module.add_function(wrap_pyfunction!(meshes::outward_turns, module)?)?;
    module.add_function(wrap_pyfunction!(meshes::depth_of, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::exr_channels, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::read_exr, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::read_colour, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::read_light, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::write_colour, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::write_exr, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::picture_array, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::read_png, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::read_gray, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::read_ids, module)?)?;
    module.add_function(wrap_pyfunction!(skin::skin_reflected, module)?)?;
    module.add_function(wrap_pyfunction!(stages::export, module)?)?;
    module.add_function(wrap_pyfunction!(tangents::mikktspace, module)?)?;
    module.add_function(wrap_pyfunction!(cluster::check_worker, module)?)?;
    module.add_function(wrap_pyfunction!(cluster::run_part, module)?)?;
    module.add_function(wrap_pyfunction!(cluster::adopt, module)?)?;
    Ok(())
}
