//! `unshade.Capture`.

use std::path::PathBuf;

use capture::gbuffer::GBuffer;
use capture::{Camera, Mesh, View};
use formats::picture::{self, GrayImage, Picture};
use numpy::ndarray::{Array1, Array2};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayDyn};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scoring::score;
use solver::transport::{CHANNELS, Sky, Transport};

use super::arrays::{self, Argument};
use super::errors::{named_error, raise};
use super::threads::{detached, long};

type Floats<'py> = Bound<'py, PyArrayDyn<f32>>;

/// A capture folder, opened and checked; raises ``errors.CaptureError``. A pickle holds the path.
#[pyclass(module = "unshade", frozen)]
pub(super) struct Capture {
    pub(super) inner: capture::Capture,
}

impl Capture {
    fn view(&self, name: &str) -> PyResult<&View> {
        let found = self.inner.train.iter().find(|view| view.camera.name == name);
        found.ok_or_else(|| PyKeyError::new_err(format!("no training view is named {name:?}")))
    }
}

impl Capture {
    fn is_withheld(&self, name: &str) -> bool {
        self.inner.withheld.iter().any(|camera| camera.name == name)
    }

    fn mask_file(&self, name: &str) -> PyResult<GrayImage> {
        picture::read_png_gray(&self.inner.folder.join(format!("masks/{name}.png"))).map_err(raise)
    }
}

#[pymethods]
impl Capture {
    #[new]
    fn new(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let inner = long(py, || capture::Capture::open(&path))?.map_err(raise)?;
        Ok(Self { inner })
    }

    /// The folder.
    #[getter]
    fn path(&self) -> PathBuf {
        self.inner.folder.clone()
    }

    /// Names of the training views.
    #[getter]
    fn train(&self) -> Vec<String> {
        self.inner.train.iter().map(|view| view.camera.name.clone()).collect()
    }

    /// Names of the withheld views; their pictures belong to the truth.
    #[getter]
    fn withheld(&self) -> Vec<String> {
        self.inner.withheld.iter().map(|camera| camera.name.clone()).collect()
    }

    /// Return (height, width, 3) linear radiance of a view. That of a withheld view is its
    /// photograph, or part of the truth; raises ``errors.CaptureError`` where the capture comes
    /// without it.
    fn image<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Floats<'py>> {
        if !self.is_withheld(name) {
            return arrays::picture_to_array(py, self.view(name)?.image.clone());
        }
        let path = score::withheld_picture(&self.inner.folder, name).map_err(raise)?;
        if !path.is_file() {
            let path = path.display();
            let reason =
                format!("{path}: is missing; this capture comes without its withheld pictures");
            return Err(named_error("CaptureError", &reason));
        }
        let mask = self.mask_file(name)?;
        let read = || picture::read_colour_unchecked(&path);
        let mut picture = detached(py, read)?.map_err(raise)?;
        if (picture.width, picture.height) != (mask.width, mask.height) {
            let reason = format!("{}: has another size than its mask", path.display());
            return Err(named_error("CaptureError", &reason));
        }
        picture.blacken_not_finite(|pixel| mask.data[pixel] < 128);
        arrays::picture_to_array(py, picture)
    }

    /// Return (height, width) of any view, 255 where the mesh is the first surface.
    fn mask<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArrayDyn<u8>>> {
        let mask = match self.is_withheld(name) {
            true => self.mask_file(name)?,
            false => self.view(name)?.mask.clone(),
        };
        arrays::gray_to_array(py, mask)
    }

    /// (height, width) region ids.
    fn labels<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<Option<Bound<'py, PyArrayDyn<u8>>>> {
        let labels = self.view(name)?.labels.as_ref();
        labels.map(|labels| arrays::gray_to_array(py, labels.clone())).transpose()
    }

    /// Any view's camera: pixels, and camera to world with OpenGL axes (4, 4).
    fn camera<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyDict>> {
        let camera = self.inner.camera(name);
        let camera =
            camera.ok_or_else(|| PyKeyError::new_err(format!("no view is named {name:?}")))?;
        camera_to_dict(py, camera)
    }

    /// Vertices and normals (V, 3), uvs (V, 2), triangles (F, 3); metres, world space.
    #[getter]
    fn mesh<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        mesh_to_dict(py, &self.inner.mesh)
    }

    /// The mesh at the pixel centres of any view: positions (metres) and unit normals (height,
    /// width, 3), uvs (height, width, 2); NaN where it sees nothing of it.
    fn gbuffer<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyDict>> {
        let camera = self.inner.camera(name);
        let camera =
            camera.ok_or_else(|| PyKeyError::new_err(format!("no view is named {name:?}")))?;
        let gbuffer = detached(py, || GBuffer::new(&self.inner.mesh, camera, None))?;
        let plane = |channels: usize, of: &dyn Fn(usize) -> Vec<f32>| {
            let mut picture = Picture::new(gbuffer.width, gbuffer.height, channels);
            picture.data.fill(f32::NAN);
            for (sample, pixel) in gbuffer.pixels.iter().enumerate() {
                let at = *pixel as usize * channels;
                picture.data[at..at + channels].copy_from_slice(&of(sample));
            }
            arrays::picture_to_array(py, picture)
        };
        let dict = PyDict::new(py);
        dict.set_item("positions", plane(3, &|i| gbuffer.positions[i].to_array().to_vec())?)?;
        dict.set_item("normals", plane(3, &|i| gbuffer.normals[i].to_array().to_vec())?)?;
        dict.set_item("uvs", plane(2, &|i| gbuffer.uvs[i].to_array().to_vec())?)?;
        Ok(dict)
    }

    /// The diffuse shading (N, N, 3) of the mesh in an environment (rows, 2 rows, 3), lat-long as
    /// ``truth/light.exr``, on a sphere of 1 / ``nearness`` metres, with the mesh's own shadows and
    /// bounces: 1 for radiance 1 from everywhere. A diffuse layer is albedo times shading.
    #[pyo3(signature = (light, *, texture_size=128, nearness=0.0, bounces=2, bounce_albedo=0.4))]
    fn shading<'py>(
        &self,
        py: Python<'py>,
        light: &Bound<'py, PyAny>,
        texture_size: usize,
        nearness: f32,
        bounces: usize,
        bounce_albedo: f32,
    ) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
        let light = Argument { name: "light", class: "ValueError" }.light(light)?;
        let mut config = solver::config::UnshadeConfig::default();
        let transport = &mut config.transport;
        (transport.texture_size, transport.rows) = (texture_size, light.height);
        (transport.bounces, transport.bounce_albedo) = (bounces, bounce_albedo);
        solver::Config::Unshade(config.clone()).validate().map_err(raise)?;
        let data = long(py, || {
            let sky = Sky::lat_long(light.height).at(nearness);
            let (mesh, transport) = (&self.inner.mesh, &config.transport);
            Transport::new(mesh, &sky, transport, config.seed).shading(&light.data)
        })?;
        let (width, height) = (texture_size, texture_size);
        arrays::picture_to_array(py, Picture { width, height, channels: CHANNELS, data })
    }

    /// Pictures (height, width, 3) of training views by name as a texture (size, size, 3): the mean
    /// of what they show at a texel, weighted by the cosine, and 255 where one of them shows it.
    fn project<'py>(
        &self,
        py: Python<'py>,
        pictures: &Bound<'py, PyDict>,
        size: usize,
    ) -> PyResult<(Floats<'py>, Bound<'py, PyArrayDyn<u8>>)> {
        let argument = Argument { name: "pictures", class: "ValueError" };
        if !(1..=8192).contains(&size) {
            return Err(argument.refused("texture of another size than 1 to 8192 texels"));
        }
        let mut views = Vec::new();
        for (name, picture) in pictures.iter() {
            let view = self.view(name.extract()?)?;
            let image = argument.picture(&picture)?;
            let (w, h) = (view.camera.width, view.camera.height);
            if (image.width, image.height, image.channels) != (w, h, 3) {
                return Err(argument.refused(&format!("{name}: expected shape ({h}, {w}, 3)")));
            }
            views.push(View { image, ..view.clone() });
        }
        let found = long(py, || capture::mean_texture::project(&self.inner.mesh, &views, size))?;
        let data = found.seen.iter().map(|seen| if *seen { 255 } else { 0 }).collect();
        let seen = GrayImage { width: size, height: size, data };
        Ok((arrays::picture_to_array(py, found.mean)?, arrays::gray_to_array(py, seen)?))
    }

    /// Return the true maps of a synthetic capture. Raises ``errors.MapsError`` without a truth.
    fn truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let maps = py.import("unshade.maps")?.getattr("Maps")?;
        maps.call_method1("read", (self.inner.folder.join("truth"),))
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("unshade.thumbnails")?.call_method1("of_capture", (slf,))
    }

    /// For pickles and copies: the folder is opened again.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let arguments = (slf.get().path(),);
        Ok((slf.get_type(), arguments).into_pyobject(slf.py())?.into_any())
    }

    fn __repr__(&self) -> String {
        let (train, withheld) = (self.inner.train.len(), self.inner.withheld.len());
        let folder = self.inner.folder.display();
        format!("Capture({folder}: {train} training views, {withheld} withheld)")
    }
}

fn camera_to_dict<'py>(py: Python<'py>, camera: &Camera) -> PyResult<Bound<'py, PyDict>> {
    let matrix = camera.camera_to_world;
    let matrix: Bound<'py, PyArray2<f32>> =
        Array2::from_shape_fn((4, 4), |(row, column)| matrix.col(column)[row]).into_pyarray(py);
    let dict = PyDict::new(py);
    dict.set_item("width", camera.width)?;
    dict.set_item("height", camera.height)?;
    dict.set_item("focal", camera.focal)?;
    dict.set_item("centre", camera.centre)?;
    dict.set_item("camera_to_world", matrix)?;
    Ok(dict)
}

fn mesh_to_dict<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Bound<'py, PyDict>> {
    let rows = |array: Bound<'py, PyArray1<f32>>, width: usize| {
        array.call_method1("reshape", ((-1, width as isize),))
    };
    let vectors = |vectors: &[glam::Vec3]| {
        rows(vectors.iter().flat_map(|v| v.to_array()).collect::<Array1<_>>().into_pyarray(py), 3)
    };
    let uvs: Array1<f32> = mesh.uvs.iter().flat_map(|uv| uv.to_array()).collect();
    let triangles: Array1<u32> = mesh.triangles.iter().flatten().copied().collect();
    let dict = PyDict::new(py);
    dict.set_item("vertices", vectors(&mesh.positions)?)?;
    dict.set_item("normals", vectors(&mesh.normals)?)?;
    dict.set_item("uvs", rows(uvs.into_pyarray(py), 2)?)?;
    dict.set_item("triangles", triangles.into_pyarray(py).call_method1("reshape", ((-1, 3),))?)?;
    Ok(dict)
}
