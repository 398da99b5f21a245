//! Keys of stages: hashes of what they read, and of nothing else. An output is valid while its key is the same.

use std::io;

use formats::content_hash::hash_parts;

use super::cases::Case;
use super::competitor::Class;
use super::error::RunError;
use super::method::MethodKind;
use super::output::Output;
use super::plan::{Kind, Task};
use super::preflight::Ready;
use super::scene::Scene;
use super::workshop::{Contents, Workshop};

/// Key of a stage's inputs, as a hash and in words.
pub(super) struct Key {
    pub hash: String,
    pub made_from: String,
}

impl Key {
    fn of(parts: &[&str]) -> Self {
        Self { hash: hash_parts(parts), made_from: String::new() }
    }
}

impl Workshop<'_> {
    /// Key of a stage; `contents` hold the stages that come before it.
    pub fn key(&self, task: &Task, contents: &Contents) -> Result<Key, RunError> {
        let case = &self.suite.cases[task.case];
        let of = |kind: Kind| {
            let name = task.id.split_once('/').map_or("", |(_, name)| name);
            let name = if matches!(kind, Kind::Capture | Kind::Lights) { &case.id } else { name };
            contents.get(&format!("{}/{name}", kind.word()))
        };
        let missing =
            || RunError::Folder(io::Error::other(format!("{}: comes too early", task.id)));
        let content = |kind| of(kind).map(|output| &*output.content).ok_or_else(missing);
        let photographed = self.photographed(task.case)?;
        let capture = photographed.as_ref().or(of(Kind::Capture)).ok_or_else(missing);
        Ok(match task.kind {
            Kind::Capture => {
                let [scene, files] = scene_of(&case.scene)?;
                Key::of(&["capture", self.rendered_by("capture")?, &scene, &files])
            }
            Kind::Lights => Key::of(&["lights", &capture?.content, self.rendered_by("lights")?]),
            Kind::Maps => {
                let ready = self.ready(task).filter(|ready| ready.found).ok_or_else(missing)?;
                let lights = if ready.method.gives_pictures() { of(Kind::Lights) } else { None };
                self.key_of_maps(ready, case, capture?, lights)?
            }
            Kind::Relit => {
                let ready = self.ready(task).ok_or_else(missing)?;
                let by = if photographed.is_some() { "photographed" } else { self.suite.relight };
                let scales = self.suite.scales.join(" ");
                let mut parts = vec!["relit", &capture?.content, content(Kind::Maps)?];
                parts.extend([by, self.rendered_by(by)?, &scales]);
                // The albedo's one factor, and pictures that are a method's own, come from there.
                if self.suite.scales.contains(&"global") || ready.method.gives_pictures() {
                    parts.push(self.sources.scores);
                }
                Key::of(&parts)
            }
            Kind::Scores => {
                let [maps, relit] = [content(Kind::Maps)?, content(Kind::Relit)?];
                let mut parts = vec!["scores", &capture?.content, maps, relit, self.sources.scores];
                if let Some(net) = self.suite.lpips {
                    parts.extend([net, self.rendered_by("lpips")?]);
                }
                parts.extend(self.suite.metrics.key(self.tools)?);
                Key::of(&parts)
            }
        })
    }

    fn rendered_by(&self, stage: &str) -> Result<&str, RunError> {
        let reason =
            || format!("the package `unshade` has no stage {stage:?}; install this version of it");
        Ok(self.renderer.of(stage).ok_or_else(|| io::Error::other(reason()))?)
    }

    /// Key of a method's maps: what the method is given, and what it is.
    fn key_of_maps(
        &self,
        ready: &Ready,
        case: &Case,
        capture: &Output,
        lights: Option<&Output>,
    ) -> Result<Key, RunError> {
        let given = &*capture.given;
        Ok(match (&ready.method.kind, &ready.files) {
            (MethodKind::Fields { config, backend }, _) => {
                // The resolved values, so that a preset that changed is solved again; and what
                // computes here, since no two devices give the same bytes.
                let config = solver::Config::from_toml(config)?.to_toml();
                let backend = backend.open()?.name();
                let parts = ["fields", given, &config, &backend, self.sources.solver];
                let made_from = format!("this program's sources of the solver, on {backend}");
                Key { made_from, ..Key::of(&parts) }
            }
            (MethodKind::Program(program), Some(files)) => {
                let ours = self.rendered_by("python")?;
                let program_key = files.key(program, &self.trees, ours)?;
                let mut parts = vec!["program", given, &program_key];
                if ready.method.gives_pictures() {
                    // Its pictures become maps by the code that reads captures.
                    parts.push(self.sources.capture);
                }
                parts.extend(lights.map(|lights| &*lights.content));
                Key { made_from: files.in_words(program), ..Key::of(&parts) }
            }
            (MethodKind::Baseline { baseline, texture_size }, _) => {
                let size = texture_size.to_string();
                Key::of(&["baseline", given, baseline.name(), &size, self.sources.solver])
            }
            (MethodKind::Competitor { competitor, settings }, _) => {
                let renderer = self.rendered_by(competitor.name)?;
                let mut parts = vec!["competitor", given, competitor.name, settings, renderer];
                // It is given photographs of its own of the scene, whatever else that is relit in.
                let scene = scene_of(&case.scene.clone().without_relight())?;
                if competitor.class != Class::Passive {
                    parts.extend(scene.iter().map(String::as_str));
                }
                Key::of(&parts)
            }
            (MethodKind::LabelMeans, _) => {
                Key::of(&["label-means", given, &capture.truth, self.sources.scores])
            }
            (MethodKind::Oracle | MethodKind::Program(_), _) => {
                Key::of(&["oracle", &capture.truth, self.sources.scores])
            }
        })
    }
}

/// A scene, and the content of the files that it names.
fn scene_of(scene: &Scene) -> Result<[String; 2], RunError> {
    Ok([scene.to_toml().map_err(io::Error::other)?, scene.content()?])
}

#[cfg(test)]
mod tests;
