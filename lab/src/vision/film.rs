//! A video or a camera, decoded by the `ffmpeg` program and followed from its first picture to its last.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow, bail};
use serde::Serialize;
use tenax_vision::frame::{FRAME_BYTES, Frame, HEIGHT, WIDTH};
use tenax_vision::quality::Blind;
use tenax_vision::{Camera, Summary};

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    Video(PathBuf),
    /// A camera of Video4Linux, such as /dev/video0.
    Device(PathBuf),
}

impl Source {
    /// Starts `ffmpeg`, which gives planes green, blue, red. Fails if the source is not there, or `ffmpeg` is not installed.
    fn open(&self) -> Result<Decoder> {
        let (Self::Video(path) | Self::Device(path)) = self;
        let size = format!("{WIDTH}x{HEIGHT}");
        if !path.exists() {
            bail!("{} is not there", path.display());
        }
        let mut command = Command::new("ffmpeg");
        command.args(["-nostdin", "-v", "error"]);
        if matches!(self, Self::Device(_)) {
            command.args(["-f", "v4l2", "-video_size", &size]);
        }
        command.arg("-i").arg(path).args(["-fps_mode", "passthrough", "-s", &size]);
        command.args(["-f", "rawvideo", "-pix_fmt", "gbrp", "-"]).stdout(Stdio::piped());
        let mut ffmpeg = command.spawn().map_err(|error| match error.kind() {
            ErrorKind::NotFound => anyhow!("the program ffmpeg decodes pictures, and it is not installed"),
            _ => anyhow::Error::from(error).context("cannot start ffmpeg"),
        })?;
        let planes = ffmpeg.stdout.take().context("ffmpeg has no output")?;
        Ok(Decoder { ffmpeg, planes })
    }
}

struct Decoder {
    ffmpeg: Child,
    planes: ChildStdout,
}

impl Decoder {
    /// Reads the next picture. False after the last. Fails if `ffmpeg` could not decode it.
    fn next(&mut self, planes: &mut [u8]) -> Result<bool> {
        match self.planes.read_exact(planes) {
            Ok(()) => Ok(true),
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => {
                if !self.ffmpeg.wait().context("ffmpeg does not end")?.success() {
                    bail!("ffmpeg cannot decode it");
                }
                Ok(false)
            }
            Err(error) => Err(error).context("cannot read from ffmpeg"),
        }
    }
}

impl Drop for Decoder {
    fn drop(&mut self) {
        // After an error ffmpeg may still be decoding.
        let _ = self.ffmpeg.kill();
        let _ = self.ffmpeg.wait();
    }
}

#[derive(Clone, Debug)]
pub struct Plan {
    pub source: Source,
    /// Pictures a second of a video.
    pub rate_hz: f64,
    /// Folder of markers.csv and object.csv.
    pub folder: Option<PathBuf>,
    /// Whether a video is followed at its rate instead of as fast as it is decoded.
    pub live: bool,
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
    /// Pictures that were not to be believed, and times that none came for 200 ms.
    pub blind: BTreeMap<&'static str, usize>,
}

const fn name(blind: Blind) -> &'static str {
    match blind {
        Blind::Lost(_) => "lost",
        Blind::Late(_) => "late",
        Blind::Frozen(_) => "frozen",
        Blind::Covered => "covered",
    }
}

/// Follows all of a source's pictures; the object's colours are learned while `holds` is false. `told` gets each summary and its
/// picture's age, ms. Fails if pictures cannot be read, or results not written.
pub fn follow(
    plan: &Plan,
    holds: &AtomicBool,
    mut told: impl FnMut(&Summary, u16) -> Result<()>,
) -> Result<Report> {
    let mut tables = plan.folder.as_deref().map(Tables::create).transpose()?;
    let mut decoder = plan.source.open()?;
    let mut planes = vec![0; FRAME_BYTES];
    let mut camera = Camera::default();
    let mut report = Report::default();
    let mut worked = Duration::ZERO;
    let (mut updates, mut failed, mut objects, mut slips) = (0, 0, 0, 0);
    let mut last = Vec::new();
    let mut begun = None;
    while decoder.next(&mut planes)? {
        let begun = *begun.get_or_insert_with(Instant::now);
        let due = Duration::from_secs_f64(report.frames as f64 / plan.rate_hz);
        // A camera's picture comes when it is taken, as far as anybody knows.
        let (taken, now) = match &plan.source {
            Source::Device(_) => (begun.elapsed(), begun.elapsed()),
            Source::Video(_) if plan.live => {
                sleep(due.saturating_sub(begun.elapsed()));
                (due, begun.elapsed())
            }
            Source::Video(_) => (due, due),
        };
        let [taken_ms, now_ms] = [taken, now].map(|at| at.as_millis() as u32);
        let silence = camera.silence(now_ms).filter(|_| report.frames > 0);
        let frame = Frame::from_gbrp(&planes).context("a picture's size")?;
        let start = Instant::now();
        let summary = camera.picture(&frame, !holds.load(Ordering::Relaxed), taken_ms, now_ms);
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
        for blind in silence.into_iter().chain(summary.blind) {
            *report.blind.entry(name(blind)).or_default() += 1;
        }
        if let Some(tables) = &mut tables {
            tables.write(&camera, &summary)?;
        }
        told(&summary, now_ms.saturating_sub(taken_ms).try_into().unwrap_or(u16::MAX))?;
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
        let object = "frame,area,x,y,angle_rad,cut,slip_px_s,moving_px,slips,flow_x,flow_y,shear_x_px,shear_y_px,normal_px,twist_px2,blind";
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
            summary.slip_px_s,
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
