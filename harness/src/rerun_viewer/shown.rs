//! A solve as it goes, in the rerun viewer: the pictures at their cameras around the mesh, the loss of
//! every stage as it falls, and at the end the light, the maps after each stage, and the mesh in its
//! albedo.

use std::collections::HashMap;
use std::fmt::Display;
use std::time::Duration;

use capture::{Capture, View};
use formats::Maps;
use formats::picture::Picture;
use glam::Mat3;
use report::tone::{self, Raster};
use rerun::{
    Image, Mesh3D, Pinhole, RecordingStream, RecordingStreamBuilder, RecordingStreamResult,
    Scalars, Transform3D, ViewCoordinates, components,
};
use solver::{Progress, Solution};

use super::error::ViewerError;

/// How long a viewer may take to answer.
const PATIENCE: Duration = Duration::from_secs(5);
/// Steps over all stages.
const TIMELINE: &str = "iteration";
/// The specular albedo that is shown white.
const SPECULAR_WHITE: f32 = 0.05;

/// Where a solve is shown.
pub struct RerunViewer {
    stream: RecordingStream,
    mesh: Mesh3D,
    /// The last step of every stage.
    ends: HashMap<String, i64>,
}

impl RerunViewer {
    /// `place` is a file that ends in `.rrd`, or the address of a viewer
    /// (`rerun+http://127.0.0.1:9876/proxy`). Shows what the capture holds.
    pub fn open(place: &str, capture: &Capture) -> Result<Self, ViewerError> {
        let builder = RecordingStreamBuilder::new("unshade");
        let stream = match place.ends_with(".rrd") {
            true => builder.save(place),
            false => builder.connect_grpc_opts(place),
        };
        let stream =
            stream.map_err(failed(&format!("neither a file .rrd nor an address: {place}")))?;
        let viewer = Self { stream, mesh: mesh(capture), ends: HashMap::new() };
        viewer.capture(capture).map_err(failed(place))?;
        let silent = |_| ViewerError(format!("{place}: no viewer answers; start one with `rerun`"));
        viewer.stream.flush_with_timeout(PATIENCE).map_err(silent)?;
        Ok(viewer)
    }

    /// The loss before the last step.
    pub fn step(&mut self, progress: &Progress) {
        let step = progress.iteration as i64;
        self.stream.set_time_sequence(TIMELINE, step);
        self.ends.insert(progress.stage.to_owned(), step);
        let path = format!("loss/{}", progress.stage);
        if let Err(error) = self.stream.log(path, &Scalars::single(progress.loss)) {
            tracing::warn!("the loss is not shown: {error}");
        }
    }

    /// Shows a solution: maps at the steps after which they were so.
    pub fn solution(&self, solution: &Solution) -> Result<(), ViewerError> {
        self.log_solution(solution).map_err(failed("the maps are not shown"))?;
        self.stream.flush_blocking().map_err(failed("the maps are not shown"))
    }

    fn capture(&self, capture: &Capture) -> RecordingStreamResult<()> {
        self.stream.log_static("head", &ViewCoordinates::RIGHT_HAND_Y_UP())?;
        self.stream.log_static("head/mesh", &self.mesh)?;
        for view in &capture.train {
            let path = format!("head/cameras/{}", view.camera.name);
            let picture = tone::colour(&view.image, 1.0);
            self.stream.log_static(path.as_str(), &transform(view))?;
            self.stream.log_static(path.as_str(), &pinhole(view, &picture))?;
            self.stream.log_static(path, &image(picture))?;
        }
        Ok(())
    }

    fn log_solution(&self, solution: &Solution) -> RecordingStreamResult<()> {
        for after in &solution.stages {
            if let Some(end) = self.ends.get(&after.stage) {
                self.stream.set_time_sequence(TIMELINE, *end);
                self.maps(&after.maps)?;
            }
        }
        let last = self.ends.values().max().copied().unwrap_or_default();
        self.stream.set_time_sequence(TIMELINE, last + 1);
        if let Some(light) = &solution.light {
            self.stream.log("light", &image(tone::colour(&light.picture(), 1.0)))?;
        }
        self.maps(&solution.maps)
    }

    fn maps(&self, maps: &Maps) -> RecordingStreamResult<()> {
        let log = |name: &str, map: &Option<Picture>, raster: &dyn Fn(&Picture) -> Raster| match map
        {
            Some(map) => self.stream.log(format!("maps/{name}"), &image(raster(map))),
            None => Ok(()),
        };
        log("diffuse_albedo", &maps.diffuse_albedo, &|map| tone::colour(map, 1.0))?;
        log("specular_albedo", &maps.specular_albedo, &|map| tone::grey(map, SPECULAR_WHITE))?;
        log("diffuse_normal", &maps.diffuse_normal, &tone::normals)?;
        log("specular_normal", &maps.specular_normal, &tone::normals)?;
        log("confidence", &maps.confidence, &|map| tone::grey(map, 1.0))?;
        let Some(albedo) = &maps.diffuse_albedo else { return Ok(()) };
        let albedo = image(tone::colour(albedo, 1.0));
        self.stream.log("head/mesh", &Mesh3D::update_fields().with_albedo_texture_image(albedo))
    }
}

fn failed<E: Display>(what: &str) -> impl FnOnce(E) -> ViewerError + use<'_, E> {
    move |error| ViewerError(format!("{what}: {error}"))
}

fn mesh(capture: &Capture) -> Mesh3D {
    let mesh = &capture.mesh;
    let rows = |vectors: &[glam::Vec3]| -> Vec<[f32; 3]> {
        vectors.iter().map(glam::Vec3::to_array).collect()
    };
    Mesh3D::new(rows(&mesh.positions))
        .with_vertex_normals(rows(&mesh.normals))
        // The viewer's v points down.
        .with_vertex_texcoords(mesh.uvs.iter().map(|uv| [uv.x, 1.0 - uv.y]))
        .with_triangle_indices(mesh.triangles.iter().copied())
}

fn transform(view: &View) -> Transform3D {
    let pose = view.camera.camera_to_world;
    let rotation = Mat3::from_mat4(pose).to_cols_array_2d();
    Transform3D::from_translation(pose.w_axis.truncate().to_array()).with_mat3x3(rotation)
}

/// The camera, scaled to a picture that may be smaller than its own.
fn pinhole(view: &View, picture: &Raster) -> Pinhole {
    let camera = &view.camera;
    let scale = picture.width as f32 / camera.width as f32;
    let ([fx, fy], [cx, cy]) = (camera.focal.map(|v| scale * v), camera.centre.map(|v| scale * v));
    Pinhole::new([[fx, 0.0, 0.0], [0.0, fy, 0.0], [cx, cy, 1.0]])
        .with_resolution([picture.width as f32, picture.height as f32])
        .with_camera_xyz(components::ViewCoordinates::RUB)
        .with_image_plane_distance(0.1)
}

fn image(raster: Raster) -> Image {
    Image::from_rgb24(raster.bytes, [raster.width as u32, raster.height as u32])
}
