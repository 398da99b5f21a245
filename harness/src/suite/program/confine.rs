//! Permissions of a program: the kernel's Landlock, where it is there, refuses everything else.

use std::fs;
use std::path::{Path, PathBuf};

/// Paths of the system that every program needs to read: they change with its releases.
const SYSTEM: [&str; 11] =
    ["/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/etc", "/nix", "/proc", "/sys", "/run"];
/// Files below it are the user's, as those of `/opt`: a program that reads them states them.
const LOCAL: &str = "/usr/local";
/// Devices, and the memory that processes share.
const DEVICES: &str = "/dev";

/// Permissions of a program.
#[derive(Clone, Debug, Default)]
pub(super) struct Permissions {
    /// Files and folders it may read beside the system's.
    pub read: Vec<PathBuf>,
    /// Folders of which it may see the names, as an interpreter that looks for modules must.
    pub list: Vec<PathBuf>,
    /// Folders it may write.
    pub write: Vec<PathBuf>,
    /// Paths that it must not read, even inside those it may.
    pub secret: Vec<PathBuf>,
}

impl Permissions {
    /// Everything that may be read: a folder that holds a secret is taken apart.
    fn readable(&self) -> Vec<PathBuf> {
        let secrets: Vec<PathBuf> =
            self.secret.iter().filter_map(|s| s.canonicalize().ok()).collect();
        let mut readable = Vec::new();
        let mut open: Vec<PathBuf> = SYSTEM.iter().flat_map(|path| without_local(path)).collect();
        open.extend(self.read.iter().cloned());
        while let Some(path) = open.pop() {
            let Ok(real) = path.canonicalize() else { continue };
            if secrets.iter().any(|secret| real.starts_with(secret)) {
                continue;
            }
            if secrets.iter().any(|secret| secret.starts_with(&real)) {
                let entries = fs::read_dir(&real).into_iter().flatten().flatten();
                open.extend(entries.map(|entry| entry.path()));
            } else {
                readable.push(real);
            }
        }
        readable
    }
}

/// Restricts this thread and all that it starts. False where the kernel has no Landlock.
#[cfg(target_os = "linux")]
pub(super) fn restrict(permissions: &Permissions) -> Result<bool, String> {
    use landlock::{
        ABI, Access, AccessFs, Ruleset, RulesetAttr, RulesetCreatedAttr, RulesetStatus,
        path_beneath_rules,
    };
    let abi = ABI::V5;
    let (all, read) = (AccessFs::from_all(abi), AccessFs::from_read(abi));
    let restricted = || {
        Ruleset::default()
            .handle_access(all)?
            .create()?
            .add_rules(path_beneath_rules(permissions.readable(), read))?
            .add_rules(path_beneath_rules(&permissions.list, AccessFs::ReadDir))?
            .add_rules(path_beneath_rules(&permissions.write, all))?
            .add_rules(path_beneath_rules([DEVICES], all))?
            .restrict_self()
    };
    let status = restricted().map_err(|error| error.to_string())?;
    Ok(status.ruleset != RulesetStatus::NotEnforced)
}

/// Restricts nothing: this system has no such thing.
#[cfg(not(target_os = "linux"))]
pub(super) fn restrict(_: &Permissions) -> Result<bool, String> {
    Ok(false)
}

/// Whether `path` leads to one of the paths that a program may read anyway.
pub(super) fn is_system(path: &Path) -> bool {
    SYSTEM.iter().any(|system| path.starts_with(system)) && !path.starts_with(LOCAL)
}

/// A path of the system, taken apart if it holds what is not the system's.
fn without_local(path: &str) -> Vec<PathBuf> {
    if !Path::new(LOCAL).starts_with(path) {
        return vec![PathBuf::from(path)];
    }
    let entries = fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path());
    entries.filter(|entry| entry != Path::new(LOCAL)).collect()
}
