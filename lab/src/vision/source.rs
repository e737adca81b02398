//! Pictures, decoded by the `ffmpeg` program: it knows every format and camera, and it is started, not linked.

use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};

use anyhow::{Context, Result, bail};
use tenax_scene::picture::{Options, Session};
use tenax_vision::frame::{FRAME_BYTES, HEIGHT, WIDTH};

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    Video(PathBuf),
    /// A camera of Video4Linux, such as /dev/video0.
    Device(PathBuf),
    /// Pictures, one after the other.
    Pictures(Vec<PathBuf>),
    Drawn {
        seed: u64,
        rate_hz: u32,
    },
}

/// Pictures of 320 x 240, planes green, blue, red.
#[derive(Debug)]
pub enum Pictures {
    Decoded(Decoded),
    Drawn(Box<Session>),
}

#[derive(Debug)]
pub struct Decoded {
    ffmpeg: Child,
    planes: ChildStdout,
    /// The list that ffmpeg reads while it runs.
    _list: Option<tempfile::NamedTempFile>,
    what: String,
}

impl Source {
    /// Starts to decode. Fails if it is not there, or `ffmpeg` is not installed.
    pub fn open(&self) -> Result<Pictures> {
        let mut command = Command::new("ffmpeg");
        command.args(["-nostdin", "-v", "error"]);
        let mut list = None;
        let what = match self {
            Self::Video(path) => {
                there(path)?;
                command.arg("-i").arg(path);
                path.display().to_string()
            }
            Self::Device(path) => {
                there(path)?;
                command.args(["-f", "v4l2", "-video_size", &format!("{WIDTH}x{HEIGHT}"), "-i"]).arg(path);
                path.display().to_string()
            }
            &Self::Drawn { seed, rate_hz } => {
                return Ok(Pictures::Drawn(Box::new(session(seed, rate_hz))));
            }
            Self::Pictures(paths) => {
                list = Some(list_of(paths)?);
                let file = list.as_ref().map(tempfile::NamedTempFile::path);
                command.args(["-f", "concat", "-safe", "0", "-i"]).args(file);
                format!("{} pictures", paths.len())
            }
        };
        command.args(["-fps_mode", "passthrough", "-vf", &format!("scale={WIDTH}:{HEIGHT}")]);
        command.args(["-f", "rawvideo", "-pix_fmt", "gbrp", "-"]).stdout(Stdio::piped());
        let mut ffmpeg = command.spawn().map_err(|error| match error.kind() {
            ErrorKind::NotFound => {
                anyhow::anyhow!("the program ffmpeg decodes pictures, and it is not installed")
            }
            _ => anyhow::Error::from(error).context("cannot start ffmpeg"),
        })?;
        let planes = ffmpeg.stdout.take().context("ffmpeg has no output")?;
        Ok(Pictures::Decoded(Decoded { ffmpeg, planes, _list: list, what }))
    }

    /// The lens, where it is known: its focal length, px.
    pub fn focal_px(&self) -> Option<f32> {
        let &Self::Drawn { seed, rate_hz } = self else { return None };
        Some(session(seed, rate_hz).lens().focal_px as f32)
    }

    /// Pictures a second that a video says it has.
    pub fn rate_hz(&self) -> Option<f64> {
        let path = match self {
            Self::Video(path) => path,
            Self::Drawn { rate_hz, .. } => return Some(f64::from(*rate_hz)),
            _ => return None,
        };
        let probe = "-v error -select_streams v:0 -show_entries stream=r_frame_rate -of csv=p=0".split(' ');
        let told = Command::new("ffprobe").args(probe).arg(path).output().ok()?;
        let told = String::from_utf8(told.stdout).ok()?;
        let (over, under) = told.trim().trim_end_matches(',').split_once('/')?;
        Some(over.parse::<f64>().ok()? / under.parse::<f64>().ok()?)
            .filter(|rate| rate.is_finite() && *rate > 0.0)
    }
}

impl Pictures {
    /// Reads the next picture. False after the last. Fails if `ffmpeg` could not decode it.
    pub fn next(&mut self, planes: &mut [u8; FRAME_BYTES]) -> Result<bool> {
        let decoded = match self {
            Self::Decoded(decoded) => decoded,
            Self::Drawn(session) => return Ok(session.picture(&mut planes[..]).is_some()),
        };
        match decoded.planes.read_exact(planes) {
            Ok(()) => Ok(true),
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => {
                let ended = decoded.ffmpeg.wait().context("ffmpeg does not end")?;
                if !ended.success() {
                    bail!("ffmpeg cannot decode {}", decoded.what);
                }
                Ok(false)
            }
            Err(error) => Err(error).context("cannot read from ffmpeg"),
        }
    }
}

impl Drop for Decoded {
    fn drop(&mut self) {
        // Whoever stops reading early wants no more of it.
        let _ = self.ffmpeg.kill();
        let _ = self.ffmpeg.wait();
    }
}

fn session(seed: u64, rate_hz: u32) -> Session {
    Session::new(Options { seed, rate_hz: rate_hz.into(), fisheye: true })
}

fn there(path: &Path) -> Result<()> {
    if !path.exists() {
        bail!("{} is not there", path.display());
    }
    Ok(())
}

/// The list of pictures as ffmpeg's concat reads it.
fn list_of(paths: &[PathBuf]) -> Result<tempfile::NamedTempFile> {
    let mut list = tempfile::NamedTempFile::new().context("cannot write a list for ffmpeg")?;
    for path in paths {
        let path = std::path::absolute(path)?;
        there(&path)?;
        let quoted = path.display().to_string().replace('\'', "'\\''");
        // Without a length each, ffmpeg drops pictures as repeated.
        writeln!(list, "file '{quoted}'\nduration 0.1")?;
    }
    list.flush()?;
    Ok(list)
}
