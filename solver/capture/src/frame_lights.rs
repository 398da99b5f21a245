//! The light of every frame: its group of frames, and whether it turns with the camera.

use glam::Mat4;
use serde_json::Value;

use super::camera::Camera;

/// The frame of reference in which a capture's lights stand still.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightFrame {
    /// The head: cameras move around it.
    #[default]
    Head,
    /// The camera: the head turns before it, or the lamps are mounted on it.
    Camera,
}

impl LightFrame {
    /// Parses the value of `light_frame`; the error is the reason alone.
    pub(super) fn parse(value: Option<&Value>) -> Result<Self, String> {
        match value {
            None => Ok(Self::Head),
            Some(Value::String(text)) if text == "head" => Ok(Self::Head),
            Some(Value::String(text)) if text == "camera" => Ok(Self::Camera),
            Some(other) => Err(format!(
                "light_frame is {other}; write \"head\" if the light stands still with respect to \
                 the head, \"camera\" if with respect to the camera"
            )),
        }
    }
}

/// The lights of a capture's frames, those of training views first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameLights {
    /// Where the lights stand still.
    pub frame: LightFrame,
    /// The names of the groups of frames that share a light, in the order of their first training view; empty if no
    /// frame names its light, which is one group without a name.
    pub names: Vec<String>,
    /// The group and the pose of the light's frame in the head's, of each frame.
    frames: Vec<(usize, Mat4)>,
}

impl FrameLights {
    /// Groups the frames by the names of their lights: the training frames, then the `withheld` last ones. The error is
    /// the reason alone.
    pub(super) fn new(
        frame: LightFrame,
        frames: &[(&Camera, Option<&str>)],
        withheld: usize,
    ) -> Result<Self, String> {
        let trained = frames.len() - withheld;
        let mut names: Vec<String> = vec![];
        let mut of_frames = vec![];
        for (at, (camera, name)) in frames.iter().enumerate() {
            let group = match name {
                None => 0,
                Some(name) => match names.iter().position(|known| known == name) {
                    Some(group) => group,
                    None if at < trained => {
                        names.push((*name).to_owned());
                        names.len() - 1
                    }
                    None => {
                        return Err(format!(
                            "frame {:?} is withheld and its light {name:?} lights no training \
                             frame; train on a frame of this light or drop the frame",
                            camera.name
                        ));
                    }
                },
            };
            let pose = match frame {
                LightFrame::Head => Mat4::IDENTITY,
                LightFrame::Camera => camera.camera_to_world,
            };
            of_frames.push((group, pose));
        }
        Ok(Self { frame, names, frames: of_frames })
    }

    /// The number of groups.
    pub fn groups(&self) -> usize {
        self.names.len().max(1)
    }

    /// The group of every frame, and the pose of the frame of reference of its light in that of the head, metres.
    pub fn of_frames(&self) -> &[(usize, Mat4)] {
        &self.frames
    }

    /// The reason why one light that stands still with respect to the head does not describe all frames, with the key
    /// of `transforms.json` that says so, if there is one.
    pub fn beyond_one_still_light(&self) -> Option<&'static str> {
        match (self.frame, self.groups()) {
            (LightFrame::Camera, _) => {
                Some("the light moves with the camera (light_frame in transforms.json)")
            }
            (LightFrame::Head, 1) => None,
            (LightFrame::Head, _) => {
                Some("the frames have several lights (light in transforms.json)")
            }
        }
    }
}

/// Checks the `light` of a frame; the error is the reason alone.
pub(super) fn light_name(value: &Value) -> Result<Option<String>, String> {
    match value {
        Value::Null => Ok(None),
        Value::String(name)
            if !(name.is_empty() || name.starts_with('.') || name.contains(['/', '\\'])) =>
        {
            Ok(Some(name.clone()))
        }
        other => Err(format!(
            "light is {other}; write the name of the frames that share its light, which can be a \
             file name"
        )),
    }
}

/// Refuses frames of which some name their light and others do not; the error is the reason alone.
pub(super) fn require_all_or_none<'a>(
    lights: impl Iterator<Item = (&'a str, bool)> + Clone,
) -> Result<(), String> {
    let with = lights.clone().find(|(_, has_light)| *has_light);
    let without = lights.clone().find(|(_, has_light)| !has_light);
    match (with, without) {
        (Some((with, _)), Some((without, _))) => Err(format!(
            "frame {without}: has no light, but frame {with} has one; name the light of every \
             frame or of none"
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use serde_json::json;

    use super::*;
    use crate::testing;
    use crate::{Capture, CaptureError};

    /// The lights of a capture of two training views and a withheld one, whose `transforms.json` is edited.
    fn lights(edit: impl FnOnce(&mut Value)) -> Result<FrameLights, CaptureError> {
        let folder = tempfile::tempdir().unwrap();
        let mesh = testing::dome(6);
        let shade = |p: glam::Vec3| (p.abs(), 1);
        let views: Vec<_> =
            testing::rig(3, 16).iter().map(|camera| testing::view(&mesh, camera, shade)).collect();
        testing::write_capture(folder.path(), &mesh, &views, 1);
        let path = folder.path().join("transforms.json");
        let mut transforms = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
        edit(&mut transforms);
        fs::write(&path, transforms.to_string()).unwrap();
        Capture::open(folder.path()).map(|capture| capture.lights)
    }

    fn named(names: [Value; 3]) -> Result<FrameLights, CaptureError> {
        lights(|transforms| {
            for (frame, name) in names.into_iter().enumerate() {
                transforms["frames"][frame]["light"] = name;
            }
        })
    }

    #[test]
    fn a_capture_without_the_keys_has_one_light_that_stands_still() {
        let still = lights(|_| ()).unwrap();
        assert_eq!(still.of_frames(), [(0, Mat4::IDENTITY); 3]);
        assert_eq!((still.groups(), still.beyond_one_still_light()), (1, None));
        assert_eq!(lights(|t| t["light_frame"] = json!("head")).unwrap(), still);
        let one = named([json!("flash"), json!("flash"), json!("flash")]).unwrap();
        assert_eq!((one.groups(), one.beyond_one_still_light()), (1, None));
    }

    #[test]
    fn frames_are_grouped_by_the_names_of_their_lights() {
        let lights = named([json!("no flash"), json!("flash"), json!("no flash")]).unwrap();
        assert_eq!(lights.names, ["no flash", "flash"]);
        let groups: Vec<usize> = lights.of_frames().iter().map(|(group, _)| *group).collect();
        assert_eq!(groups, [0, 1, 0]);
        assert!(lights.beyond_one_still_light().unwrap().contains("light in transforms.json"));
    }

    #[test]
    fn lights_that_stand_still_with_the_camera_turn_with_it() {
        let lights = lights(|t| t["light_frame"] = json!("camera")).unwrap();
        for ((_, pose), camera) in lights.of_frames().iter().zip(testing::rig(3, 16)) {
            // +Z of the camera is behind it.
            let behind = camera.position().normalize();
            assert!(pose.transform_vector3(glam::Vec3::Z).distance(behind) < 1e-5);
        }
        assert!(lights.beyond_one_still_light().unwrap().contains("light_frame"));
    }

    #[test]
    fn faults_are_named_with_their_frame_and_key() {
        let cases = [
            (lights(|t| t["light_frame"] = json!("room")), "light_frame is \"room\"; write"),
            (lights(|t| t["light_frame"] = json!(1)), "light_frame is 1; write"),
            (named([json!("a"), json!("a"), Value::Null]), "frame images/002.exr: has no light"),
            (named([json!(1), json!("a"), json!("a")]), "frame images/000.exr: light is 1"),
            (named([json!("a"), json!("a/b"), json!("a")]), "frame images/001.exr: light is"),
            (named([json!(""), json!("a"), json!("a")]), "frame images/000.exr: light is \"\""),
            (named([json!("a"), json!("a"), json!("b")]), "its light \"b\" lights no training"),
        ];
        for (result, expected) in cases {
            let message = result.unwrap_err().to_string();
            assert!(message.contains(expected) && message.contains("transforms.json"), "{message}");
        }
    }
}
