//! The pinhole camera.

use glam::{Mat4, Vec3};

/// A pinhole camera; pixel (i, j) has its centre at (i + 0.5, j + 0.5), row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name of the frame in maps and scores: "000".
    pub name: String,
    /// Columns of the picture.
    pub width: usize,
    /// Rows of the picture.
    pub height: usize,
    /// Focal lengths in pixels, horizontal and vertical.
    pub focal: [f32; 2],
    /// Principal point in pixels.
    pub centre: [f32; 2],
    /// Camera to world, OpenGL axes: x right, y up, looking down -z. A rigid motion, metres.
    pub camera_to_world: Mat4,
}

impl Camera {
    /// World to camera, OpenGL axes.
    pub fn world_to_camera(&self) -> Mat4 {
        self.camera_to_world.inverse()
    }

    /// The position of the camera, metres in world space.
    pub fn position(&self) -> Vec3 {
        self.camera_to_world.w_axis.truncate()
    }

    /// World point to (column, row, depth): pixels, and metres along the optical axis. The depth
    /// is positive in front of the camera; behind it the pixel is undefined.
    pub fn project(&self, point: Vec3) -> Vec3 {
        self.project_local(self.world_to_camera().transform_point3(point))
    }

    /// [`Camera::project`] of a point in the camera's axes.
    pub fn project_local(&self, local: Vec3) -> Vec3 {
        let depth = -local.z;
        Vec3::new(
            self.centre[0] + self.focal[0] * local.x / depth,
            self.centre[1] - self.focal[1] * local.y / depth,
            depth,
        )
    }

    /// Side of a pixel on a plane at `depth` metres that faces the camera, metres.
    pub fn footprint(&self, depth: f32) -> f32 {
        depth / self.focal[0].min(self.focal[1])
    }

    /// The camera of the picture that [`super::View::half`] makes.
    pub fn half(&self) -> Self {
        Self {
            name: self.name.clone(),
            width: self.width / 2,
            height: self.height / 2,
            focal: self.focal.map(|value| value / 2.0),
            centre: self.centre.map(|value| value / 2.0),
            camera_to_world: self.camera_to_world,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_is_right_and_up_is_a_smaller_row() {
        let camera = Camera {
            name: "000".to_owned(),
            width: 100,
            height: 80,
            focal: [50.0; 2],
            centre: [50.0, 40.0],
            camera_to_world: Mat4::from_translation(Vec3::new(0.0, 0.0, 2.0)),
        };
        let pixel = camera.project(Vec3::new(0.4, 0.2, 0.0));
        assert!((pixel - Vec3::new(60.0, 35.0, 2.0)).length() < 1e-5, "{pixel}");
        let half = camera.half().project(Vec3::new(0.4, 0.2, 0.0));
        assert!((half - Vec3::new(30.0, 17.5, 2.0)).length() < 1e-5, "{half}");
        assert!(camera.project(Vec3::new(0.0, 0.0, 3.0)).z < 0.0);
    }
}
