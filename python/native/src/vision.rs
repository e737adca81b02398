//! A camera behind a clear skin, and the pictures that a drawn one takes.

use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray2, PyArray3, PyReadonlyArray3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use tenax_scene::picture::{Options, Session};
use tenax_vision::frame::{FRAME_BYTES, HEIGHT, PIXELS, WIDTH};
use tenax_vision::quality::Blind;
use tenax_vision::rectify::Rectifier;
use tenax_vision::{Frame, Summary};

#[pyclass]
pub struct Camera(tenax_vision::Camera);

#[pymethods]
impl Camera {
    /// `focal_px`: of a fisheye; infinite: straight lines are straight.
    #[new]
    fn new(focal_px: f32) -> Self {
        let mut camera = tenax_vision::Camera::default();
        if focal_px.is_finite() {
            camera.rectify(Rectifier::new(focal_px));
        }
        Self(camera)
    }

    /// A picture (240 x 320 x 3, red first) that was taken at `taken_ms` and comes at `now_ms`.
    fn picture<'py>(
        &mut self,
        py: Python<'py>,
        picture: PyReadonlyArray3<'py, u8>,
        learn: bool,
        taken_ms: u32,
        now_ms: u32,
    ) -> PyResult<Bound<'py, PyDict>> {
        let picture = picture.as_array();
        if picture.dim() != (HEIGHT, WIDTH, 3) {
            return Err(PyValueError::new_err(format!("a picture is {HEIGHT} x {WIDTH} x 3 bytes")));
        }
        let planes: Vec<u8> = [1, 2, 0]
            .map(|colour| picture.slice(numpy::ndarray::s![.., .., colour]))
            .iter()
            .flatten()
            .copied()
            .collect();
        let summary = py.detach(|| {
            let frame = Frame::from_gbrp(&planes).expect("its length is a picture's");
            self.0.picture(&frame, learn, taken_ms, now_ms)
        });
        told(py, &summary)
    }

    /// Of each marker: where it rests, where it is (px), and whether that is known.
    fn markers<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f32>> {
        let all = self.0.markers().map_or(&[][..], |markers| markers);
        let rows =
            all.iter().flat_map(|own| [own.rest.at.x, own.rest.at.y, own.at.x, own.at.y, own.known().into()]);
        Array2::from_shape_vec((all.len(), 5), rows.collect()).expect("five a marker").into_pyarray(py)
    }

    /// The pixels that are the object's.
    fn object<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<bool>> {
        let mask = self.0.object().object();
        Array2::from_shape_fn((HEIGHT, WIDTH), |(y, x)| mask.contains(x, y)).into_pyarray(py)
    }
}

const fn why(blind: Blind) -> &'static str {
    match blind {
        Blind::Late(_) => "late",
        Blind::Frozen(_) => "frozen",
        Blind::Covered => "covered",
    }
}

fn told<'py>(py: Python<'py>, summary: &Summary) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    table.set_item("blind", summary.blind.map(why))?;
    table.set_item("markers", summary.markers)?;
    table.set_item("force", summary.forces.map(|own| (own.x, own.y, own.normal, own.twist)))?;
    let object = summary.object.map(|own| {
        let middle = own.moments.middle;
        (middle.x, middle.y, own.area, own.angle_rad)
    });
    table.set_item("object", object)?;
    table.set_item("moves_px", summary.flow.map(|flow| (flow.x, flow.y)))?;
    table.set_item("skin_px", summary.skin_flow.map(|flow| (flow.x, flow.y)))?;
    table.set_item("slip_px_s", summary.slip_px_s)?;
    table.set_item("slips", summary.slips())?;
    table.set_item("codes", summary.codes())?;
    Ok(table)
}

/// What a drawn camera sees: an object comes, is gripped, and slips.
#[pyclass]
pub struct Skin {
    session: Session,
    planes: Vec<u8>,
}

type Seen<'py> = (Bound<'py, PyArray3<u8>>, f64, bool, bool);

#[pymethods]
impl Skin {
    #[new]
    fn new(seed: u64, rate_hz: f64) -> Self {
        Self {
            session: Session::new(Options { seed, rate_hz, fisheye: false }),
            planes: vec![0; FRAME_BYTES],
        }
    }

    /// The next picture, when it is taken (s), whether the hand grips and whether the object slides. None after the last.
    fn picture<'py>(&mut self, py: Python<'py>) -> Option<Seen<'py>> {
        let truth = self.session.picture(&mut self.planes)?;
        let red_first =
            |(y, x, colour): (usize, usize, usize)| self.planes[[2, 0, 1][colour] * PIXELS + y * WIDTH + x];
        let picture = Array3::from_shape_fn((HEIGHT, WIDTH, 3), red_first).into_pyarray(py);
        Some((picture, truth.t_s, truth.gripped, truth.slides))
    }
}
