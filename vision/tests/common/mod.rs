//! Recordings of the real sensor, decoded by the `ffmpeg` program, and pictures that are drawn.
#![allow(dead_code, reason = "each test binary uses a part of it")]

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use tenax_vision::frame::{FRAME_BYTES, Frame, PIXELS, Plane, WIDTH};

pub fn recording(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/fingervision").join(name)
}

pub fn for_each_frame(video: &Path, mut each: impl FnMut(usize, Frame)) {
    let mut ffmpeg = Command::new("ffmpeg")
        .args(["-v", "error", "-i"])
        .arg(video)
        .args(["-fps_mode", "passthrough", "-f", "rawvideo", "-pix_fmt", "gbrp", "-"])
        .stdout(Stdio::piped())
        .spawn()
        .expect("ffmpeg is installed");
    let mut bytes = vec![0; FRAME_BYTES];
    let mut frames = ffmpeg.stdout.take().expect("piped");
    let mut number = 0;
    while frames.read_exact(&mut bytes).is_ok() {
        each(number, Frame::from_gbrp(&bytes).expect("whole"));
        number += 1;
    }
    assert!(ffmpeg.wait().expect("ffmpeg ends").success());
}

pub fn plane(level: u8) -> Box<Plane> {
    vec![level; PIXELS].into_boxed_slice().try_into().expect("its size")
}

pub struct Noise(pub u64);

impl Noise {
    /// Evenly from 0 to 1.
    pub fn even(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }

    pub fn normal(&mut self) -> f32 {
        (0..12).map(|_| self.even()).sum::<f32>() - 6.0
    }
}

pub fn draw_discs(
    discs: &[(f32, f32, f32)],
    background: impl Fn(f32, f32) -> f32,
    sigma: f32,
    noise: &mut Noise,
    into: &mut Plane,
) {
    for (at, level) in into.iter_mut().enumerate() {
        let (x, y) = ((at % WIDTH) as f32, (at / WIDTH) as f32);
        let covered = discs
            .iter()
            .map(|&(cx, cy, r)| (r - (x - cx).hypot(y - cy)).clamp(-1.0, 1.0) * 0.5 + 0.5)
            .fold(0.0, f32::max);
        let clean = background(x, y) * (1.0 - covered) + 18.0 * covered;
        *level = (clean + sigma * noise.normal()).round().clamp(0.0, 255.0) as u8;
    }
}
