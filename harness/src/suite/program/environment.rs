//! The environment of a program: what unshade and the suite state, and nothing of the caller's.

use std::collections::BTreeMap;
use std::env;
use std::path::Path;

use super::SEED;
use super::start::Program;

/// Folders of the system's programs.
const PATH: &str = "/usr/local/bin:/usr/bin:/bin:/usr/local/sbin:/usr/sbin:/sbin";

/// Environment variables that libraries take their number of threads from.
const THREADS: [&str; 6] = [
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "NUMEXPR_NUM_THREADS",
    "RAYON_NUM_THREADS",
    "NUMBA_NUM_THREADS",
];

impl Program {
    /// Variables with values that are the same whoever runs it: they are part of its key.
    pub(super) fn variables(&self) -> BTreeMap<String, String> {
        let fixed = [
            ("LANG", "C.UTF-8"),
            ("PATH", PATH),
            ("PYTHONUNBUFFERED", "1"),
            ("PYTHONDONTWRITEBYTECODE", "1"),
        ];
        let mut variables: BTreeMap<String, String> =
            fixed.map(|(name, value)| (name.to_owned(), value.to_owned())).into();
        if let Some(threads) = self.limits.threads {
            variables.extend(THREADS.map(|name| (name.to_owned(), threads.to_string())));
        }
        if let Some(seed) = self.settings.get("seed") {
            variables.insert(SEED.to_owned(), seed.to_string());
        }
        variables.extend(self.environment.clone());
        variables
    }

    /// All variables, of a program in the folder `beside`, whose neighbours it may start; and packages of the user, whose
    /// content is part of its key, lie in the home folder that is the user's.
    pub(super) fn all_variables(&self, beside: &Path) -> BTreeMap<String, String> {
        let mut variables = self.variables();
        if !self.environment.contains_key("PATH") {
            variables.insert("PATH".to_owned(), format!("{}:{PATH}", beside.display()));
        }
        let home = || Some(Path::new(&env::var_os("HOME")?).join(".local").display().to_string());
        if let Some(packages) = env::var("PYTHONUSERBASE").ok().or_else(home) {
            variables.entry("PYTHONUSERBASE".to_owned()).or_insert(packages);
        }
        variables
    }
}
