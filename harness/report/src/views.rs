//! The comparison figures of the withheld views: by the methods themselves, and relit by the path tracer.

use std::fs;
use std::path::PathBuf;

use formats::picture::Content;
use rayon::prelude::*;

use super::comparison_figures::{
    self, ComparisonFigure, Made, MethodFolders, Show, Strip, Studio, Subject,
};
use super::difference::Measure;
use super::error::ReportError;
use super::metric;
use super::reference::{Reference, own_light};
use super::run::Frame;

/// A picture as a whole, or one part of its exact split.
#[derive(Clone, Copy)]
pub(super) struct Layer {
    name: Option<&'static str>,
    words: &'static str,
    pub channels: &'static [&'static str],
    pub exposure: f32,
}

impl Layer {
    pub const ALL: Self = Self { name: None, words: "", channels: &["R", "G", "B"], exposure: 1.0 };
    pub const DIFFUSE: Self = Self {
        name: Some("diffuse"),
        words: ", diffuse layer",
        channels: &["diffuse.R", "diffuse.G", "diffuse.B"],
        exposure: 1.0,
    };
    /// Several times darker than the picture it belongs to, hence the exposure.
    pub const SPECULAR: Self = Self {
        name: Some("specular"),
        words: ", specular layer",
        channels: &["specular.R", "specular.G", "specular.B"],
        exposure: 3.0,
    };

    fn subject(&self, source: &Source) -> String {
        match self.name {
            None => source.subject().to_owned(),
            Some(name) => format!("{}_{name}_layer", source.subject()),
        }
    }
}

/// The source of a picture of a withheld view.
enum Source {
    /// The method's own view synthesis.
    View,
    /// The path tracer, from the method's maps.
    Relit { light: String, scale: &'static str },
}

impl Source {
    fn subject(&self) -> &'static str {
        match self {
            Source::View => "view",
            Source::Relit { .. } => "relit",
        }
    }

    fn light(&self) -> Option<&str> {
        match self {
            Source::View => None,
            Source::Relit { light, .. } => Some(light),
        }
    }

    /// The scale mode of the scores that belong to the picture.
    fn scale(&self) -> &'static str {
        match self {
            Source::View => "none",
            Source::Relit { scale, .. } => scale,
        }
    }

    fn path(&self, method: &MethodFolders, file: &str) -> Option<PathBuf> {
        match self {
            Source::View => Some(method.maps.as_ref()?.join("views").join(file)),
            Source::Relit { light, scale } => {
                Some(method.relit.as_ref()?.join(scale).join(light).join(file))
            }
        }
    }
}

impl Studio<'_> {
    /// The withheld views: by the methods themselves, then relit in every light.
    pub fn view_figures(&self) -> Result<Vec<ComparisonFigure>, ReportError> {
        let mut sources = vec![(Source::View, Layer::ALL)];
        sources.extend(self.lights()?.into_iter().map(|light| (self.relit(light), Layer::ALL)));
        self.figures(&sources)
    }

    /// The exact split of the withheld views in the capture's light.
    pub fn layer_figures(&self) -> Result<Vec<ComparisonFigure>, ReportError> {
        let sources = [Layer::DIFFUSE, Layer::SPECULAR]
            .map(|layer| [(Source::View, layer), (self.relit(self.light.to_owned()), layer)]);
        self.figures(sources.as_flattened())
    }

    fn figures(&self, sources: &[(Source, Layer)]) -> Result<Vec<ComparisonFigure>, ReportError> {
        let figures = sources.par_iter();
        figures.filter_map(|(source, layer)| self.view_figure(source, layer).transpose()).collect()
    }

    /// Relit pictures with the albedo after its one factor, if anything was rendered so.
    fn relit(&self, light: String) -> Source {
        let mut folders = self.methods.iter().filter_map(|method| method.relit.as_ref());
        let scaled = folders.any(|folder| folder.join("global").is_dir());
        Source::Relit { light, scale: if scaled { "global" } else { "none" } }
    }

    fn view_figure(
        &self,
        source: &Source,
        layer: &Layer,
    ) -> Result<Option<ComparisonFigure>, ReportError> {
        let mut strips = Vec::new();
        for frame in &self.frames.test {
            strips.extend(self.view_strip(source, frame, layer)?);
        }
        let made = strips.iter().flat_map(|strip| &strip.entries);
        if made.filter(|entry| entry.picture.is_some()).count() == 0 {
            return Ok(None);
        }
        let made_by = match source {
            Source::View => "by the method itself".to_owned(),
            Source::Relit { light, scale } => {
                let light = match light == self.light {
                    true => own_light(light),
                    false => light.clone(),
                };
                format!("maps relit: {light} (albedo {})", metric::scale(scale))
            }
        };
        let withheld = match self.frames.reference {
            Reference::Truth => "Withheld view",
            Reference::Photograph => "Withheld photograph",
        };
        let title = format!("{withheld}{}, {made_by}", layer.words);
        let subject = layer.subject(source);
        let show = Show::Colour { exposure: layer.exposure };
        let subject = (subject.as_str(), source.light());
        let reference = self.frames.reference;
        Ok(Some(ComparisonFigure::new(subject, reference, title, show, Measure::Display, strips)))
    }

    /// Returns whether the figure at the head of the case is of such pictures: another light than the capture's, if there
    /// is one.
    fn is_key(&self, source: &Source) -> Result<bool, ReportError> {
        let lights = self.lights()?;
        Ok(source
            .light()
            .is_some_and(|light| lights.get(1).or(lights.first()).is_some_and(|key| key == light)))
    }

    /// The lights with pictures to compare with, the capture's own first.
    fn lights(&self) -> Result<Vec<String>, ReportError> {
        let folder = self.frames.root.join("truth/relit");
        if self.frames.reference == Reference::Photograph || !folder.is_dir() {
            return Ok(vec![self.light.to_owned()]);
        }
        let mut lights = Vec::new();
        for entry in fs::read_dir(&folder).map_err(|error| ReportError::read(&folder, error))? {
            let entry = entry.map_err(|error| ReportError::read(&folder, error))?;
            lights.push(entry.file_name().to_string_lossy().into_owned());
        }
        lights.sort_by_key(|light| (light != self.light, light.clone()));
        Ok(lights)
    }

    fn view_strip(
        &self,
        source: &Source,
        frame: &Frame,
        layer: &Layer,
    ) -> Result<Option<Strip>, ReportError> {
        let file = format!("{}.exr", frame.name);
        let photographed = self.frames.reference == Reference::Photograph;
        if photographed && layer.name.is_some() {
            return Ok(None);
        }
        let path = match source {
            Source::View if layer.name.is_none() => frame.image.clone(),
            Source::View => self.frames.root.join("truth/layers").join(&file),
            Source::Relit { light, .. } => match self.frames.relit_reference(frame, light) {
                Some(path) => path,
                None => return Ok(None),
            },
        };
        let Some(truth) =
            comparison_figures::read_if_present(&path, layer.channels, Content::Colour)?
        else {
            return Ok(None);
        };
        let mask = match &frame.mask {
            Some(mask) => comparison_figures::read_mask_if_present(mask)?,
            None => None,
        };
        let (id, light) = (layer.subject(source), source.light());
        let name: Vec<&str> =
            std::iter::once(id.as_str()).chain(light).chain([frame.name.as_str()]).collect();
        let subject = Subject {
            name: name.join("-"),
            title: format!("view {}", frame.name),
            input: self.frames.nearest_train(frame.direction),
            truth,
            path,
            mask,
            show: Show::Colour { exposure: layer.exposure },
            measure: Measure::Display,
            scaled: false,
            values: layer.name.is_none()
                && self.is_key(source)?
                && self.frames.test.first().is_some_and(|first| first.name == frame.name),
        };
        let strip = self.strip(&subject, |method| {
            let Some(path) = source.path(method, &file) else { return Ok(None) };
            let made = comparison_figures::read_if_present(&path, layer.channels, Content::Colour)?;
            let score = method.column.find(&id, light, "psnr_srgb", source.scale());
            let caption = comparison_figures::caption(score, Some(&frame.name));
            Ok(made.map(|picture| Made { picture, path, caption }))
        })?;
        Ok(Some(strip))
    }
}
