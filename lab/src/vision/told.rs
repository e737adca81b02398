//! A camera's summaries as messages for a board.

use tenax_hal_shim::behaviour::{CameraView, MARKERS, NORMAL_STEP_MN, SHEAR_STEP_MN, UNTRACKED};
use tenax_hal_shim::wire::Down;
use tenax_hal_shim::words::Code;
use tenax_vision::frame::PIXELS;
use tenax_vision::{Camera, Summary};

/// Moving points that a slip of 1 px a picture stands for, in 1/10,000 of the picture: an object covers some 10 % of it, and a fifth of its
/// points have an edge.
const MOVING_E4_PER_PX: f32 = 200.0;

/// Force of a marker's move, mN/px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    pub normal_mn: f32,
    /// Shear along the finger, which is the picture's y.
    pub shear_mn: f32,
}

/// Gains of the drawn skin.
pub const GAINS: Gains = Gains { normal_mn: 100.0, shear_mn: 40.0 };

/// The camera's view for the board's behaviours. None while the camera is blind: its silence tells the board.
pub fn view(camera: &Camera, summary: &Summary, gains: Gains, age_ms: u16) -> Option<CameraView> {
    if summary.blind.is_some() {
        return None;
    }
    let mut view = CameraView {
        age_ms,
        moving_e4: 0,
        angle_ddeg: None,
        normal: [UNTRACKED; MARKERS],
        shear: [0; MARKERS],
    };
    if let Some(object) = summary.object {
        if summary.slips() {
            let counted = u64::from(object.slip_px) * 10_000 / PIXELS as u64;
            // A slow slip moves few points far enough to be counted: as many are told as its speed stands for.
            let stands_for = summary.slip_px().map_or(0.0, |px| MOVING_E4_PER_PX * px.min(1.0));
            view.moving_e4 = counted.max(stands_for as u64) as u16;
        }
        view.angle_ddeg = (!object.cut).then(|| (object.angle_rad.to_degrees() * 10.0).round() as i16);
    }
    let markers = camera.markers().map_or(&[][..], |markers| markers);
    // A skin may have more markers than a view has room for: then every second, third, ... of them tells.
    let step = markers.len().div_ceil(MARKERS).max(1);
    let slots = view.normal.iter_mut().zip(&mut view.shear);
    for (marker, (normal, shear)) in markers.iter().step_by(step).zip(slots) {
        if marker.known() {
            let (x, y) = marker.moved();
            let steps = |force_mn: f32, step_mn: i32| (force_mn / step_mn as f32).round();
            *normal = steps(x.hypot(y) * gains.normal_mn, NORMAL_STEP_MN).min(f32::from(UNTRACKED - 1)) as u8;
            *shear = steps(y * gains.shear_mn, SHEAR_STEP_MN) as i8;
        }
    }
    Some(view)
}

/// The teacher's words, None while the camera has nothing to say.
pub fn teach(summary: &Summary, age_ms: u16) -> Option<Down> {
    let code = |value: i8| match value {
        ..0 => Code::Minus,
        0 => Code::Zero,
        1.. => Code::Plus,
    };
    summary.codes().map(|(v1, v2)| Down::Teach { codes: [code(v1), code(v2)], age_ms })
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_scene::picture::{Options, Session};
    use tenax_vision::frame::{FRAME_BYTES, Frame};

    #[test]
    fn a_drawn_slip_reaches_the_board_and_a_late_picture_does_not() {
        let mut session = Session::new(Options { seed: 2, rate_hz: 30.0, fisheye: true });
        let mut camera = Camera::default();
        let mut planes = vec![0; FRAME_BYTES];
        let (mut slid, mut moved, mut forces, mut taught) = (0, 0, 0, 0);
        while let Some(truth) = session.picture(&mut planes) {
            let frame = Frame::from_gbrp(&planes).unwrap();
            let now_ms = (truth.t_s * 1e3) as u32;
            let late = (2_000..2_100).contains(&now_ms);
            let taken_ms = if late { now_ms - 200 } else { now_ms };
            let summary = camera.picture(&frame, !truth.gripped, taken_ms, now_ms);
            let Some(view) = view(&camera, &summary, GAINS, 5) else {
                assert!(late && teach(&summary, 5).is_none());
                continue;
            };
            assert!(!late);
            slid += usize::from(truth.slides && truth.gripped);
            moved += usize::from(truth.slides && truth.gripped && view.moving_e4 > 5);
            forces += usize::from(
                truth.gripped && view.normal.iter().any(|&normal| normal != UNTRACKED && normal > 5),
            );
            taught += usize::from(summary.codes().is_some_and(|(v1, _)| v1 == -1));
        }
        // That they arrive is what is asked here; how many are seen `tenax vision` measures.
        assert!(slid >= 40 && moved >= 10, "{moved} of {slid} pictures");
        assert!(forces >= 100 && taught >= 20, "{forces} {taught}");
    }
}
