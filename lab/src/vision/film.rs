//! A video, a folder of pictures or a camera, followed from its first picture to its last.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use serde::Serialize;
use tenax_vision::frame::Frame;
use tenax_vision::quality::Blind;
use tenax_vision::rectify::Rectifier;
use tenax_vision::{Camera, Summary};

use super::feed::{Fault, Feed, Next};
use super::source::Source;

#[derive(Clone, Debug)]
pub struct Plan {
    pub source: Source,
    /// Pictures a second, unless the video says it.
    pub rate_hz: Option<f64>,
    pub folder: Option<PathBuf>,
    /// Whether they come as a camera's do and not as fast as they are decoded.
    pub live: bool,
    pub fault: Option<Fault>,
    /// Whether a hand holds something, where somebody knows: from then on the object's colours are known.
    pub holds: Option<Arc<AtomicBool>>,
}

#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    pub frames: usize,
    /// Pictures a second that one core follows.
    pub fps_per_core: f64,
    pub markers: usize,
    /// Share of a marker's updates that failed.
    pub failed_share: f64,
    /// The longest way that a known marker went from one picture to the next, px.
    pub longest_jump_px: f64,
    pub object_share: f64,
    /// Share of the pictures in which it slips.
    pub slip_share: f64,
    /// Pictures that were not to be believed.
    pub blind: Blindness,
}

#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Blindness {
    /// None came for too long: times.
    pub lost: usize,
    /// The picture was too old.
    pub late: usize,
    pub frozen: usize,
    pub covered: usize,
}

#[derive(Debug)]
pub enum Told<'a> {
    /// A picture, and its age, ms.
    Picture(&'a Camera, &'a Summary, u16),
    /// Why the camera has nothing to say while no picture comes.
    Silence(Blind),
}

impl Plan {
    fn rate_hz(&self) -> f64 {
        self.rate_hz.or_else(|| self.source.rate_hz()).unwrap_or(30.0)
    }

    /// Opens the source. Fails if it is not there.
    pub fn open(&self) -> Result<Feed> {
        Feed::open(&self.source, self.rate_hz(), self.fault, self.live)
    }
}

/// Follows all of a source's pictures; `told` hears of each. Fails if pictures cannot be read, or results not written.
pub fn follow(plan: &Plan, mut feed: Feed, mut told: impl FnMut(Told<'_>) -> Result<()>) -> Result<Report> {
    let mut tables = plan.folder.as_deref().map(Tables::create).transpose()?;
    let mut camera = Camera::default();
    if let Some(focal_px) = plan.source.focal_px() {
        camera.rectify(Rectifier::new(focal_px));
    }
    let mut report = Report::default();
    let mut worked = Duration::ZERO;
    let (mut updates, mut failed, mut objects, mut slips) = (0, 0, 0, 0);
    let mut last = Vec::new();
    loop {
        let (planes, taken_ms, now_ms) = match feed.take()? {
            Next::Picture(planes, taken_ms, now_ms) => (planes, taken_ms, now_ms),
            Next::Silence(now_ms) => {
                if let Some(blind) = camera.silence(now_ms) {
                    report.blind.lost += 1;
                    told(Told::Silence(blind))?;
                }
                continue;
            }
            Next::End => break,
        };
        let frame = Frame::from_gbrp(&planes[..]).context("a picture's size")?;
        let learn = plan.holds.as_ref().is_none_or(|holds| !holds.load(Ordering::Relaxed));
        let start = Instant::now();
        let summary = camera.picture(&frame, learn, taken_ms, now_ms);
        worked += start.elapsed();
        if let Some(markers) = camera.markers() {
            last.resize(markers.len(), None);
            for (marker, last) in markers.iter().zip(&mut last) {
                updates += 1;
                failed += usize::from(marker.found.is_err());
                if marker.known() {
                    let jump = last.map_or(0.0, |last| marker.at.distance(last));
                    report.longest_jump_px = report.longest_jump_px.max(jump.into());
                    *last = Some(marker.at);
                }
            }
        }
        objects += usize::from(summary.object.is_some());
        slips += usize::from(summary.slips());
        match summary.blind {
            Some(Blind::Late(_)) => report.blind.late += 1,
            Some(Blind::Frozen(_)) => report.blind.frozen += 1,
            Some(Blind::Covered) => report.blind.covered += 1,
            Some(Blind::Lost(_)) | None => (),
        }
        if let Some(tables) = &mut tables {
            tables.write(&camera, &summary)?;
        }
        let age_ms = now_ms.saturating_sub(taken_ms).try_into().unwrap_or(u16::MAX);
        told(Told::Picture(&camera, &summary, age_ms))?;
        report.frames += 1;
    }
    let share = |part: usize, all: usize| part as f64 / all.max(1) as f64;
    report.fps_per_core = report.frames as f64 / worked.as_secs_f64().max(1e-9);
    report.markers = camera.markers().map_or(0, |markers| markers.len());
    report.failed_share = share(failed, updates);
    report.object_share = share(objects, report.frames);
    report.slip_share = share(slips, report.frames);
    Ok(report)
}

/// markers.csv and object.csv.
struct Tables {
    markers: csv::Writer<File>,
    object: csv::Writer<File>,
}

impl Tables {
    fn create(folder: &Path) -> Result<Self> {
        let create = |name: &str, header: &str| -> Result<_> {
            let path = folder.join(name);
            let file = File::create(&path).with_context(|| format!("cannot write {}", path.display()))?;
            let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(file);
            writer.write_record(header.split(','))?;
            Ok(writer)
        };
        let object = "frame,area,x,y,angle_rad,cut,slip_px,moving_px,slips,flow_x,flow_y,shear_x_px,shear_y_px,normal_px,twist_px2,blind";
        Ok(Self {
            markers: create("markers.csv", "frame,marker,x,y,radius,dx,dy,growth,known,failure")?,
            object: create("object.csv", object)?,
        })
    }

    fn write(&mut self, camera: &Camera, summary: &Summary) -> Result<()> {
        let &Summary { frame, object, flow, forces, blind, .. } = summary;
        for (number, marker) in camera.markers().into_iter().flat_map(|markers| markers.iter()).enumerate() {
            let (dx, dy) = marker.moved();
            let (at, radius) = (marker.at, marker.rest.radius() + marker.growth);
            let failure = marker.found.err().map(|failure| format!("{failure:?}"));
            let known = u8::from(marker.known());
            let row = (frame, number, at.x, at.y, radius, dx, dy, marker.growth, known, failure);
            self.markers.serialize(row)?;
        }
        self.object.serialize((
            frame,
            object.map_or(0.0, |own| own.area),
            object.map(|own| own.moments.middle.x),
            object.map(|own| own.moments.middle.y),
            object.map(|own| own.angle_rad),
            object.map(|own| u8::from(own.cut)),
            object.map_or(0, |own| own.slip_px),
            camera.object().moving().count(),
            u8::from(summary.slips()),
            flow.map(|own| own.x),
            flow.map(|own| own.y),
            forces.map(|own| own.x),
            forces.map(|own| own.y),
            forces.map(|own| own.normal),
            forces.map(|own| own.twist),
            blind.map(|own| format!("{own:?}")),
        ))?;
        Ok(())
    }
}
