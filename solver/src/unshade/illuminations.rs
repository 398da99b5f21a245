//! The illuminations of a capture: the light of each group of frames, turned to the head.
//!
//! The unknowns are the radiances of all groups, one after the other, in the frame of reference in which the lights
//! stand still. Frames of equal group and rotation share an illumination, which is a linear function of its group's
//! radiance. A capture of one light that stands still has one illumination, the light itself.

use std::borrow::Cow;

use capture::FrameLights;
use glam::{Mat3, Mat4, Vec3};

use crate::model::kept::Kept;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::transport::{self, LightRotation, Transport};

/// Largest difference between the entries of two poses that are one: a tenth of a milliradian, a tenth of a
/// millimetre.
const SAME_POSE: f32 = 1e-4;

/// The light of frames that are lit alike.
#[derive(Clone)]
struct Illumination {
    group: usize,
    /// The head's pose; `None` for a light that stands still with respect to the head.
    head: Option<HeadPose>,
    /// The light at the distance of the transport, turned to the head; `None` is the identity.
    turned: Option<LightRotation>,
    /// The same one unit of relative nearness nearer; `None` if the distance is held fixed.
    nearer: Option<LightRotation>,
}

/// The head's pose in the frame of reference of its light.
#[derive(Clone, Copy)]
struct HeadPose {
    /// Takes directions in the frame of the light to those of the head.
    rotation: Mat3,
    /// The head's centre from its mean place, metres, in the frame of the light.
    offset: Vec3,
}

/// The illuminations of all frames.
#[derive(Clone)]
pub(super) struct Illuminations {
    /// Rows of the sky.
    rows: usize,
    illuminations: Vec<Illumination>,
    /// The illumination of every frame: training views, then withheld ones.
    of_frames: Vec<usize>,
    groups: usize,
    /// The illuminations of training views come first.
    trained: usize,
}

impl Illuminations {
    /// The illuminations of frames, of which the first `trained` are training views, for skies of `rows` rows at
    /// infinity. `centre` is that of the head.
    pub fn new(lights: &FrameLights, trained: usize, rows: usize, centre: Vec3) -> Self {
        let mut known: Vec<(usize, Mat4)> = vec![];
        let mut trained_illuminations = 0;
        let of_frame = |(frame, (group, pose)): (usize, &(usize, Mat4))| {
            let same =
                |(other, of): &(usize, Mat4)| other == group && of.abs_diff_eq(*pose, SAME_POSE);
            let at = known.iter().position(same).unwrap_or_else(|| {
                known.push((*group, *pose));
                known.len() - 1
            });
            if frame < trained {
                trained_illuminations = known.len();
            }
            at
        };
        let of_frames = lights.of_frames().iter().enumerate().map(of_frame).collect();
        let place = |pose: &Mat4| pose.inverse().transform_point3(centre);
        let places = known[..trained_illuminations].iter().map(|(_, pose)| place(pose));
        let mean = places.sum::<Vec3>() / trained_illuminations.max(1) as f32;
        let illumination = |(group, pose): &(usize, Mat4)| {
            let moves = *pose != Mat4::IDENTITY;
            let head = moves
                .then(|| HeadPose { rotation: Mat3::from_mat4(*pose), offset: place(pose) - mean });
            Illumination { group: *group, head, turned: None, nearer: None }
        };
        let illuminations = known.iter().map(illumination).collect();
        let (groups, trained) = (lights.groups(), trained_illuminations);
        Self { rows, illuminations, of_frames, groups, trained }.at(0.0)
    }

    /// The illuminations of lights of this nearness per metre. Seen from a head that moves, a near light moves too.
    #[must_use]
    pub fn at(&self, nearness: f32) -> Self {
        let turned = |HeadPose { rotation, offset }: HeadPose| {
            LightRotation::new(self.rows, rotation, nearness * offset)
        };
        let near = |light: &Illumination| Illumination {
            turned: light.head.map(turned),
            nearer: None,
            ..light.clone()
        };
        Self { illuminations: self.illuminations.iter().map(near).collect(), ..self.clone() }
    }

    /// The illuminations of lights of the transport's nearness, and their change with it if the transport has its own.
    #[must_use]
    pub fn around(&self, transport: &Transport) -> Self {
        let nearness = transport.nearness_per_metre();
        let mut near = self.at(nearness);
        if transport.has_nearness() {
            let nearer = self.at(nearness + transport.nearness_unit());
            let pairs = near.illuminations.iter_mut().zip(nearer.illuminations);
            pairs.for_each(|(light, nearer)| light.nearer = nearer.turned);
        }
        near
    }

    /// One light that stands still.
    #[cfg(test)]
    pub fn one() -> Self {
        let illuminations = vec![Illumination { group: 0, head: None, turned: None, nearer: None }];
        Self { rows: 1, illuminations, of_frames: vec![], groups: 1, trained: 1 }
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

    /// The light of an illumination around the head from the radiances of all groups, R, G, B per cell; from lights
    /// nearer by `relative_nearness`, to first order (see [`Transport::shading_nearer`]).
    pub fn light<'a>(
        &self,
        groups: &'a [f32],
        illumination: usize,
        relative_nearness: f32,
    ) -> Cow<'a, [f32]> {
        let Illumination { group, turned, nearer, .. } = &self.illuminations[illumination];
        let light = self.of_group(groups, *group);
        let Some(turned) = turned else { return Cow::Borrowed(light) };
        let seen = turned.apply(light);
        Cow::Owned(match nearer {
            None => seen,
            Some(nearer) => between(&seen, &nearer.apply(light), relative_nearness),
        })
    }

    /// The derivative of [`Self::light`] with respect to the relative nearness, if there is one.
    pub fn light_by_nearness(&self, groups: &[f32], illumination: usize) -> Option<Vec<f32>> {
        let Illumination { group, turned, nearer, .. } = &self.illuminations[illumination];
        let light = self.of_group(groups, *group);
        let (turned, nearer) = (turned.as_ref()?.apply(light), nearer.as_ref()?.apply(light));
        Some(nearer.iter().zip(&turned).map(|(nearer, turned)| nearer - turned).collect())
    }

    /// Adds the adjoint of [`Self::light`] to the gradient with respect to the radiances of all groups.
    pub fn add_adjoint(
        &self,
        by_light: &[f32],
        illumination: usize,
        relative_nearness: f32,
        by_groups: &mut [f32],
    ) {
        let Illumination { group, turned, nearer, .. } = &self.illuminations[illumination];
        let by_group = match (turned, nearer) {
            (None, _) => Cow::Borrowed(by_light),
            (Some(turned), None) => Cow::Owned(turned.adjoint(by_light)),
            (Some(turned), Some(nearer)) => {
                let nearer = nearer.adjoint(by_light);
                Cow::Owned(between(&turned.adjoint(by_light), &nearer, relative_nearness))
            }
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

/// The values on the line through two vectors: `a` at 0, `b` at 1.
fn between(a: &[f32], b: &[f32], at: f32) -> Vec<f32> {
    a.iter().zip(b).map(|(a, b)| a + at * (b - a)).collect()
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
