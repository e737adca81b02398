//! A camera behind a clear skin on drawn sessions, scored against their truth.

use std::time::{Duration, Instant};

use anyhow::Context;
use serde::{Serialize, Serializer};
use tenax_scene::picture::story::State;
use tenax_scene::picture::{Options, Session, Truth};
use tenax_vision::frame::{FRAME_BYTES, Frame};
use tenax_vision::rectify::Rectifier;
use tenax_vision::{Camera, Summary};

/// Pictures a second of the scene.
const RATE_HZ: f64 = 30.0;
/// A marker's place is that of the one that is drawn this near, px.
const SAME_PX: f64 = 3.0;
/// Faster than this, px a picture, it slips; slower than a sixth of it, it does not; between is not scored.
const SLIPS_PX: f64 = 0.3;
/// Pictures after a slip in which what moved is still seen to have moved.
const AFTER: u32 = 8;
/// Shear below which a force has no direction, px.
const SHEAR_MIN_PX: f64 = 1.0;

/// A share or mean; null where there was no occasion.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mean {
    sum: f64,
    count: u64,
}

impl Mean {
    fn add(&mut self, value: f64) {
        (self.sum, self.count) = (self.sum + value, self.count + 1);
    }

    fn count(&mut self, yes: bool) {
        self.add(f64::from(u8::from(yes)));
    }

    fn value(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }
}

impl Serialize for Mean {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        self.value().serialize(to)
    }
}

fn root<S: Serializer>(squares: &Mean, to: S) -> Result<S::Ok, S::Error> {
    squares.value().map(f64::sqrt).serialize(to)
}

#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Report {
    pub seed: u64,
    pub frames: usize,
    /// Pictures a second that one core follows, markers and object together.
    pub fps_per_core: f64,
    /// Share of the drawn markers that were calibrated.
    pub markers_found: Mean,
    /// Share of markers' updates that failed.
    pub failed_share: Mean,
    /// Distance of known markers from where they are imaged, px rms.
    #[serde(serialize_with = "root")]
    pub marker_px_rms: Mean,
    /// Direction of the shear, degrees rms.
    #[serde(serialize_with = "root")]
    pub force_deg_rms: Mean,
    /// Angle of a held object that is wholly in view, degrees rms.
    #[serde(serialize_with = "root")]
    pub angle_deg_rms: Mean,
    /// Share of the pictures with an object partly in view in which that is reported.
    pub cut_said: Mean,
    /// Share of the pictures with an object held in which it is seen.
    pub object_seen: Mean,
    /// Share of the pictures without an object in which one is seen.
    pub object_false: Mean,
    /// Share of the pictures with slip in which it is reported.
    pub recall: Mean,
    /// Share of the pictures without slip in which it is reported, of all and of those with a moving background.
    pub false_rate: Mean,
    pub false_rate_moving_background: Mean,
}

/// Draws and follows sessions. Fails if a picture has another size than the camera wants, which no session draws.
pub fn score(seed: u64, sessions: u64) -> anyhow::Result<Report> {
    let mut report = Report { seed, ..Report::default() };
    let mut worked = Duration::ZERO;
    for session in 0..sessions {
        worked += follow(seed.wrapping_add(session), &mut report)?;
    }
    report.fps_per_core = report.frames as f64 / worked.as_secs_f64().max(1e-9);
    Ok(report)
}

/// Follows a session; gives the time that the camera took.
fn follow(seed: u64, report: &mut Report) -> anyhow::Result<Duration> {
    let mut session = Session::new(Options { seed, rate_hz: RATE_HZ, fisheye: true });
    let mut camera = Camera::default();
    camera.rectify(Rectifier::new(session.lens().focal_px as f32));
    let mut planes = vec![0; FRAME_BYTES];
    let mut worked = Duration::ZERO;
    let mut pairs: Option<Vec<(usize, usize)>> = None;
    let mut before: Option<State> = None;
    let mut since_slip = AFTER;
    while let Some(truth) = session.picture(&mut planes) {
        let frame = Frame::from_gbrp(&planes).context("a picture's size")?;
        let now_ms = (truth.t_s * 1e3) as u32;
        let start = Instant::now();
        let summary = camera.picture(&frame, !truth.gripped, now_ms, now_ms);
        worked += start.elapsed();
        report.frames += 1;
        if let Some(markers) = camera.markers() {
            let pairs = pairs.get_or_insert_with(|| {
                let near = |(own, marker): (usize, &tenax_vision::markers::Marker)| {
                    let rest = marker.rest.at;
                    let drawn = truth.markers.iter().position(|(_, at)| far(rest, *at) < SAME_PX);
                    drawn.map(|drawn| (own, drawn))
                };
                markers.iter().enumerate().filter_map(near).collect()
            });
            for &(own, drawn) in pairs.iter() {
                report.failed_share.count(markers[own].found.is_err());
                if markers[own].found.is_ok() && markers[own].known() {
                    report.marker_px_rms.add(far(markers[own].at, truth.markers[drawn].0).powi(2));
                }
            }
        }
        let moved = before.map_or(0.0, |before| moved(&before, &truth.state));
        since_slip = if moved > SLIPS_PX / 6.0 { 0 } else { since_slip + 1 };
        let background = before.is_some_and(|before| before.background != truth.state.background);
        before = Some(truth.state);
        judge(&truth, &summary, (moved, since_slip, background), report);
    }
    for at in 0..session.markers() {
        let found = pairs.as_ref().is_some_and(|pairs| pairs.iter().any(|&(_, drawn)| drawn == at));
        report.markers_found.count(found);
    }
    Ok(worked)
}

fn far(at: tenax_vision::Point, (x, y): (f64, f64)) -> f64 {
    (f64::from(at.x) - x).hypot(f64::from(at.y) - y)
}

/// Move of the object against the skin from one picture to the next, px; of a turn, 60 px from the middle.
fn moved(before: &State, now: &State) -> f64 {
    let on_skin = |state: &State| (state.object.0 - state.shear_px.0, state.object.1 - state.shear_px.1);
    let ((ax, ay), (bx, by)) = (on_skin(before), on_skin(now));
    (bx - ax).hypot(by - ay) + 60.0 * (now.angle_rad - before.angle_rad).abs()
}

fn judge(
    truth: &Truth,
    summary: &Summary,
    (moved, since_slip, background): (f64, u32, bool),
    report: &mut Report,
) {
    // Until the markers are calibrated there is nothing to judge.
    if summary.markers == 0 {
        return;
    }
    if !truth.in_view {
        report.object_false.count(summary.object.is_some());
    }
    if let (true, Some(force)) = (truth.gripped, summary.forces) {
        let (x, y) = truth.state.shear_px;
        if x.hypot(y) >= SHEAR_MIN_PX {
            let off = f64::from(force.y).atan2(force.x.into()) - y.atan2(x);
            report.force_deg_rms.add(wrapped(off, std::f64::consts::TAU).to_degrees().powi(2));
        }
    }
    if truth.gripped {
        report.object_seen.count(summary.object.is_some());
        if moved > SLIPS_PX {
            report.recall.count(summary.slips());
        } else if since_slip > AFTER {
            report.false_rate.count(summary.slips());
            if background {
                report.false_rate_moving_background.count(summary.slips());
            }
        }
    }
    if let Some(object) = summary.object {
        if truth.whole && truth.gripped && !object.cut {
            let off = f64::from(object.angle_rad) - truth.state.angle_rad;
            report.angle_deg_rms.add(wrapped(off, std::f64::consts::PI).to_degrees().powi(2));
        }
        if truth.in_view && !truth.whole {
            report.cut_said.count(object.cut);
        }
    }
}

/// The difference nearest to 0 of those that are whole turns apart.
fn wrapped(off: f64, turn: f64) -> f64 {
    off - turn * (off / turn).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean speed of the slips of a drawn session, px/s: as it is seen, and the true one.
    fn speeds(seed: u64, rate_hz: f64) -> [f64; 2] {
        let mut session = Session::new(Options { seed, rate_hz, fisheye: true });
        let (mut camera, mut planes) = (Camera::default(), vec![0; FRAME_BYTES]);
        let (mut before, mut seen, mut drawn) = (None::<State>, Mean::default(), Mean::default());
        while let Some(truth) = session.picture(&mut planes) {
            let now_ms = (truth.t_s * 1e3) as u32;
            let frame = Frame::from_gbrp(&planes).unwrap();
            let summary = camera.picture(&frame, !truth.gripped, now_ms, now_ms);
            let speed = before.map_or(0.0, |before| moved(&before, &truth.state)) * rate_hz;
            before = Some(truth.state);
            if let Some(px_s) = summary.slip_px_s.filter(|_| truth.gripped && speed > 9.0) {
                seen.add(px_s.into());
                drawn.add(speed);
            }
        }
        [seen, drawn].map(|mean| mean.value().unwrap())
    }

    #[test]
    fn the_speed_of_a_slip_is_the_same_at_any_rate_of_pictures() {
        for rate_hz in [15.0, 60.0] {
            let [seen, drawn] = speeds(1, rate_hz);
            assert!((seen / drawn - 1.0).abs() < 0.1, "{rate_hz} Hz: {seen} px/s of {drawn}");
        }
    }
}
