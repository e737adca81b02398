//! The drawn scene, scored against its truth.

use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use serde::Serialize;
use tenax_scene::picture::story::State;
use tenax_scene::picture::{Options, Session, Stress, Truth};
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

/// Shares and errors over pictures. Null where the scene had no occasion.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Figures {
    /// Share of the drawn markers that were calibrated.
    pub markers_found: Option<f64>,
    /// Share of markers' updates that failed.
    pub failed_share: Option<f64>,
    /// Distance of known markers from where they are imaged, px rms.
    pub marker_px_rms: Option<f64>,
    /// Direction of the shear, degrees rms.
    pub force_deg_rms: Option<f64>,
    /// Angle of a held object that is wholly in view, degrees rms.
    pub angle_deg_rms: Option<f64>,
    /// Share of the pictures with an object partly in view in which that is reported.
    pub cut_said: Option<f64>,
    /// Share of the pictures with an object held in which it is seen.
    pub object_seen: Option<f64>,
    /// Share of the pictures without an object in which one is seen.
    pub object_false: Option<f64>,
    /// Share of the pictures with slip in which it is reported.
    pub recall: Option<f64>,
    /// Share of the pictures without slip in which it is reported, of all and of those with a moving background.
    pub false_rate: Option<f64>,
    pub false_rate_moving_background: Option<f64>,
}

#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// The first session's.
    pub seed: u64,
    pub frames: usize,
    /// Pictures a second that one core follows, markers and object together.
    pub fps_per_core: f64,
    #[serde(flatten)]
    pub all: Figures,
    /// In the order of their seeds.
    pub by_session: Vec<Figures>,
}

/// A share, or a sum of squares, and its count.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    sum: f64,
    count: u64,
}

impl Sum {
    fn count(&mut self, yes: bool) {
        (self.sum, self.count) = (self.sum + f64::from(u8::from(yes)), self.count + 1);
    }

    fn square(&mut self, off: f64) {
        (self.sum, self.count) = (self.sum + off * off, self.count + 1);
    }

    fn share(self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }

    fn rms(self) -> Option<f64> {
        self.share().map(f64::sqrt)
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Scores {
    markers_found: Sum,
    failed: Sum,
    marker_px: Sum,
    force_deg: Sum,
    angle_deg: Sum,
    cut_said: Sum,
    seen: Sum,
    unseen: Sum,
    recall: Sum,
    false_rate: Sum,
    false_moving: Sum,
}

impl Scores {
    fn sums(&mut self) -> [&mut Sum; 11] {
        [
            &mut self.markers_found,
            &mut self.failed,
            &mut self.marker_px,
            &mut self.force_deg,
            &mut self.angle_deg,
            &mut self.cut_said,
            &mut self.seen,
            &mut self.unseen,
            &mut self.recall,
            &mut self.false_rate,
            &mut self.false_moving,
        ]
    }

    fn add(&mut self, mut other: Self) {
        for (own, other) in self.sums().into_iter().zip(other.sums()) {
            (own.sum, own.count) = (own.sum + other.sum, own.count + other.count);
        }
    }

    fn figures(&self) -> Figures {
        Figures {
            markers_found: self.markers_found.share(),
            failed_share: self.failed.share(),
            marker_px_rms: self.marker_px.rms(),
            force_deg_rms: self.force_deg.rms(),
            angle_deg_rms: self.angle_deg.rms(),
            cut_said: self.cut_said.share(),
            object_seen: self.seen.share(),
            object_false: self.unseen.share(),
            recall: self.recall.share(),
            false_rate: self.false_rate.share(),
            false_rate_moving_background: self.false_moving.share(),
        }
    }
}

/// Draws and follows sessions under some stress. Fails if a picture has another size than the camera wants, which no session draws.
pub fn score(seed: u64, sessions: u64, stress: Stress) -> Result<Report> {
    let mut scores = Scores::default();
    let (mut frames, mut worked) = (0, Duration::ZERO);
    let mut by_session = Vec::new();
    for session in 0..sessions {
        let mut own = Scores::default();
        follow(seed.wrapping_add(session), stress, &mut own, (&mut frames, &mut worked))?;
        scores.add(own);
        by_session.push(own.figures());
    }
    let fps_per_core = frames as f64 / worked.as_secs_f64().max(1e-9);
    Ok(Report { seed, frames, fps_per_core, all: scores.figures(), by_session })
}

fn follow(
    seed: u64,
    stress: Stress,
    scores: &mut Scores,
    (frames, worked): (&mut usize, &mut Duration),
) -> Result<()> {
    let mut session = Session::under(Options { seed, rate_hz: RATE_HZ, fisheye: true }, stress);
    let mut camera = Camera::default();
    camera.rectify(Rectifier::new(session.lens().focal_px as f32));
    let mut planes = vec![0; FRAME_BYTES];
    let mut pairs: Option<Vec<(usize, usize)>> = None;
    let mut before: Option<State> = None;
    let mut since_slip = AFTER;
    while let Some(truth) = session.picture(&mut planes) {
        let frame = Frame::from_gbrp(&planes).context("a picture's size")?;
        let now_ms = (truth.t_s * 1e3) as u32;
        let start = Instant::now();
        let summary = camera.picture(&frame, !truth.gripped, now_ms, now_ms);
        *worked += start.elapsed();
        *frames += 1;
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
                scores.failed.count(markers[own].found.is_err());
                if markers[own].found.is_ok() && markers[own].known() {
                    scores.marker_px.square(far(markers[own].at, truth.markers[drawn].0));
                }
            }
        }
        let moved = before.map_or(0.0, |before| moved(&before, &truth.state));
        since_slip = if moved > SLIPS_PX / 6.0 { 0 } else { since_slip + 1 };
        let background = before.is_some_and(|before| before.background != truth.state.background);
        before = Some(truth.state);
        judge(&truth, &summary, (moved, since_slip, background), scores);
    }
    for at in 0..session.markers() {
        let found = pairs.as_ref().is_some_and(|pairs| pairs.iter().any(|&(_, drawn)| drawn == at));
        scores.markers_found.count(found);
    }
    Ok(())
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
    scores: &mut Scores,
) {
    // Until the markers are calibrated there is nothing to judge.
    if summary.markers == 0 {
        return;
    }
    if !truth.in_view {
        scores.unseen.count(summary.object.is_some());
    }
    if let (true, Some(force)) = (truth.gripped, summary.forces) {
        let (x, y) = truth.state.shear_px;
        if x.hypot(y) >= SHEAR_MIN_PX {
            let off = f64::from(force.y).atan2(force.x.into()) - y.atan2(x);
            scores.force_deg.square(wrapped(off, std::f64::consts::TAU).to_degrees());
        }
    }
    if truth.gripped {
        scores.seen.count(summary.object.is_some());
        if moved > SLIPS_PX {
            scores.recall.count(summary.slips());
        } else if since_slip > AFTER {
            scores.false_rate.count(summary.slips());
            if background {
                scores.false_moving.count(summary.slips());
            }
        }
    }
    if let Some(object) = summary.object {
        if truth.whole && truth.gripped && !object.cut {
            let off = f64::from(object.angle_rad) - truth.state.angle_rad;
            scores.angle_deg.square(wrapped(off, std::f64::consts::PI).to_degrees());
        }
        if truth.in_view && !truth.whole {
            scores.cut_said.count(object.cut);
        }
    }
}

/// The difference nearest to 0 of those that are whole turns apart.
fn wrapped(off: f64, turn: f64) -> f64 {
    off - turn * (off / turn).round()
}
