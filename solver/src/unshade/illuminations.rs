//! The illuminations of a capture: the light of each group of frames, turned to the head.
//!
//! The unknowns are the radiances of all groups, one after the other, in the frame of reference in which the lights
//! stand still. Frames of equal group and rotation share an illumination, which is a linear function of its group's
//! radiance. A capture of one light that stands still has one illumination, the light itself.

use std::borrow::Cow;

use capture::FrameLights;
use glam::Mat3;

use crate::model::kept::Kept;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::transport::{self, LightRotation, Transport};

/// Largest difference between the entries of two rotations that are one: a tenth of a pixel at the edge of a sky cell.
const SAME_ROTATION: f32 = 1e-4;

/// The light of frames that are lit alike.
struct Illumination {
    group: usize,
    /// `None` is the identity.
    rotation: Option<LightRotation>,
}

/// The illuminations of all frames.
pub(super) struct Illuminations {
    illuminations: Vec<Illumination>,
    /// The illumination of every frame: training views, then withheld ones.
    of_frames: Vec<usize>,
    groups: usize,
    /// The illuminations of training views come first.
    trained: usize,
}

impl Illuminations {
    /// The illuminations of frames, of which the first `trained` are training views, for skies of `rows` rows.
    pub fn new(lights: &FrameLights, trained: usize, rows: usize) -> Self {
        let mut known: Vec<(usize, Mat3)> = vec![];
        let mut trained_illuminations = 0;
        let of_frame = |(frame, (group, rotation)): (usize, &(usize, Mat3))| {
            let same = |(other, of): &(usize, Mat3)| {
                other == group && of.abs_diff_eq(*rotation, SAME_ROTATION)
            };
            let at = known.iter().position(same).unwrap_or_else(|| {
                known.push((*group, *rotation));
                known.len() - 1
            });
            if frame < trained {
                trained_illuminations = known.len();
            }
            at
        };
        let of_frames = lights.of_frames().iter().enumerate().map(of_frame).collect();
        let illumination = |(group, rotation): &(usize, Mat3)| Illumination {
            group: *group,
            rotation: (*rotation != Mat3::IDENTITY).then(|| LightRotation::new(rows, *rotation)),
        };
        Self {
            illuminations: known.iter().map(illumination).collect(),
            of_frames,
            groups: lights.groups(),
            trained: trained_illuminations,
        }
    }

    /// One light that stands still.
    #[cfg(test)]
    pub fn one() -> Self {
        let illuminations = vec![Illumination { group: 0, rotation: None }];
        Self { illuminations, of_frames: vec![], groups: 1, trained: 1 }
    }

    /// The number of groups.
    pub fn groups(&self) -> usize {
        self.groups
    }

    /// The number of illuminations.
    pub fn len(&self) -> usize {
        self.illuminations.len()
    }

    /// Whether every frame has the same illumination.
    pub fn is_one(&self) -> bool {
        self.illuminations.len() == 1
    }

    /// The number of illuminations of training views, which are the first.
    pub fn trained(&self) -> usize {
        self.trained
    }

    /// The light of an illumination around the head from the radiances of all groups, R, G, B per cell.
    pub fn light<'a>(&self, groups: &'a [f32], illumination: usize) -> Cow<'a, [f32]> {
        let Illumination { group, rotation } = &self.illuminations[illumination];
        let light = self.of_group(groups, *group);
        match rotation {
            None => Cow::Borrowed(light),
            Some(rotation) => Cow::Owned(rotation.apply(light)),
        }
    }

    /// Adds the adjoint of [`Self::light`] to the gradient with respect to the radiances of all groups.
    pub fn add_adjoint(&self, by_light: &[f32], illumination: usize, by_groups: &mut [f32]) {
        let Illumination { group, rotation } = &self.illuminations[illumination];
        let by_group = match rotation {
            None => Cow::Borrowed(by_light),
            Some(rotation) => Cow::Owned(rotation.adjoint(by_light)),
        };
        let cells = by_groups.len() / self.groups;
        let sums = by_groups[group * cells..][..cells].iter_mut();
        sums.zip(&*by_group).for_each(|(sum, by)| *sum += by);
    }

    /// The radiances of one of the groups.
    pub fn of_group<'a, T>(&self, groups: &'a [T], group: usize) -> &'a [T] {
        let cells = groups.len() / self.groups;
        &groups[group * cells..][..cells]
    }

    /// The mean [peak](Transport::peak) of the lights of all groups on a head that faces along +Z of the frame in which
    /// they stand still, to which the exposure of the pictures refers.
    pub fn peak(&self, transport: &Transport, groups: &[f32]) -> f32 {
        let peak = |group| transport.peak(self.of_group(groups, group));
        (0..self.groups).map(peak).sum::<f32>() / self.groups as f32
    }

    /// The largest [contrast](transport::contrast) of a group's light.
    pub fn contrast(&self, rows: usize, groups: &[f32]) -> f32 {
        let contrast = |group| transport::contrast(rows, self.of_group(groups, group));
        (0..self.groups).map(contrast).fold(0.0, f32::max)
    }

    /// Splits samples by their illuminations.
    pub fn parts(&self, samples: &Samples) -> Vec<PartOfSamples> {
        let of_sample = |i: usize| match self.is_one() {
            true => 0,
            false => self.of_frames[samples.view_index[i] as usize],
        };
        let mut has_samples = vec![false; self.len()];
        (0..samples.len()).for_each(|i| has_samples[of_sample(i)] = true);
        let lit: Vec<usize> = (0..self.len()).filter(|at| has_samples[*at]).collect();
        match lit.as_slice() {
            [] | [_] => {
                vec![PartOfSamples { illumination: lit.first().copied().unwrap_or(0), kept: None }]
            }
            _ => {
                let part = |illumination: &usize| PartOfSamples {
                    illumination: *illumination,
                    kept: Some(Kept::those(samples.len(), |i| of_sample(i) == *illumination)),
                };
                lit.iter().map(part).collect()
            }
        }
    }
}

/// The samples of one illumination.
#[derive(Clone, Debug)]
pub(super) struct PartOfSamples {
    pub illumination: usize,
    /// `None` for all samples.
    kept: Option<Kept>,
}

impl PartOfSamples {
    /// Its samples among all.
    pub fn samples<'a>(&self, all: &'a Samples) -> Cow<'a, Samples> {
        match &self.kept {
            None => Cow::Borrowed(all),
            Some(kept) => Cow::Owned(all.kept(kept)),
        }
    }

    /// The planes of its samples among those of all.
    pub fn planes<'a>(&self, all: &'a Planes) -> Cow<'a, Planes> {
        match &self.kept {
            None => Cow::Borrowed(all),
            Some(kept) => Cow::Owned(all.kept(kept)),
        }
    }

    /// The index of its sample `i` among all.
    pub fn source(&self, i: usize) -> usize {
        self.kept.as_ref().map_or(i, |kept| kept.source(i))
    }
}

/// Computes planes of `R` rows of `len` samples part by part; `planes` takes the index of a part as well.
pub(super) fn by_parts<const R: usize>(
    parts: &[PartOfSamples],
    len: usize,
    planes: impl Fn(usize, &PartOfSamples) -> Planes,
) -> Planes {
    if let [part] = parts {
        return planes(0, part);
    }
    let mut place = vec![(0, 0); len];
    let planes: Vec<Planes> = parts.iter().enumerate().map(|(at, part)| planes(at, part)).collect();
    for (at, part) in parts.iter().enumerate() {
        let kept = part.kept.iter().flat_map(|kept| 0..kept.len());
        kept.for_each(|i| place[part.source(i)] = (at, i));
    }
    Planes::from_fn(len, |i| {
        let (part, i) = place[i];
        planes[part].sample::<R>(i, 0)
    })
}
