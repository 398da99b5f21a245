//! The extension module `unshade._native`: bindings, nothing else.

mod arrays;
mod calls;
mod capture;
mod cluster;
mod commands;
mod errors;
mod folders;
mod gpu_of_process;
mod maps;
mod meshes;
mod metrics;
mod pictures;
mod skin;
mod tangents;
mod threads;

/// Functions and classes behind the Python package `unshade`.
#[pyo3::pymodule]
mod _native {
    use harness::suite::{CAPTURE_SOURCES, READER_SOURCES, SCORE_SOURCES, SOLVER_SOURCES};
    use pyo3::prelude::*;
    use pyo3::types::PyDict;

    #[pymodule_export]
    use super::calls::{
        judged_rows_json, read_scores, run_command_line, score_json, shown_json, solve,
        write_scores,
    };
    #[pymodule_export]
    use super::capture::Capture;
    #[pymodule_export]
    use super::cluster::{adopt, check_worker, run_remote_stage};
    #[pymodule_export]
    use super::commands::command;
    #[pymodule_export]
    use super::folders::{begin_folder, commit_folder};
    #[pymodule_export]
    use super::maps::{coverage_array, map_array, read_maps, write_maps};
    #[pymodule_export]
    use super::meshes::{depth_of, examine_layout, outward_turns, read_obj};
    #[pymodule_export]
    use super::metrics::{measure, metric_definitions, shown};
    #[pymodule_export]
    use super::pictures::{
        exr_channels, picture_array, read_colour, read_exr, read_gray, read_ids, read_light,
        read_png, write_colour, write_exr,
    };
    #[pymodule_export]
    use super::skin::skin_reflected;
    #[pymodule_export]
    use super::tangents::mikktspace;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let package = module.py().import("unshade")?.filename()?;
        let package = package.extract::<std::path::PathBuf>()?;
        harness::suite::set_scenes_folder(package.with_file_name("scenes"));
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        let sources = PyDict::new(module.py());
        sources.set_item("readers", READER_SOURCES)?;
        sources.set_item("capture", CAPTURE_SOURCES)?;
        sources.set_item("all", [SOLVER_SOURCES, SCORE_SOURCES].concat())?;
        module.add("sources", sources)?;
        module.add("subjects", report::subjects().collect::<Vec<_>>())
    }
}
