//! Our side of `vision/compare/compare.py`: frames as raw `gbrp` come in on standard input; times go out as JSON on standard
//! output, and what the mixture and the back projection say of each frame into the file that is named, a byte a pixel.

use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Read, Write};
use std::time::{Duration, Instant};

use tenax_vision::Camera;
use tenax_vision::frame::{FRAME_BYTES, Frame, PIXELS, plane};
use tenax_vision::markers::{Calibration, Markers};
use tenax_vision::mask::Mask;
use tenax_vision::object::colour::{HUES, SATURATIONS, bin};
use tenax_vision::object::{Config, Mixture, Movement, Running, Tracker};

/// Times one kind of work.
#[derive(Default)]
struct Clock(Duration);

impl Clock {
    fn time<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let done = work();
        self.0 += start.elapsed();
        done
    }
}

/// Colours of what moved, and what is like them: the paper's bins, saturating at 255 as its equation 1 does.
struct BackProjection {
    histogram: Vec<u32>,
}

impl BackProjection {
    fn step(&mut self, frame: &Frame, moving: &[u8; PIXELS], into: &mut [u8; PIXELS]) {
        let bin_at = |at: usize| {
            usize::from(bin(frame.red[at], frame.green[at], frame.blue[at])) % (HUES * SATURATIONS)
        };
        let mut new = vec![0u32; HUES * SATURATIONS];
        (0..PIXELS).filter(|&at| moving[at] == 1).for_each(|at| new[bin_at(at)] += 1);
        for (sum, new) in self.histogram.iter_mut().zip(new) {
            *sum = (*sum + new / 2).min(255);
        }
        (0..PIXELS).for_each(|at| into[at] = self.histogram[bin_at(at)] as u8);
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut dump = std::env::args().nth(1).map(File::create).transpose()?.map(BufWriter::new);
    let (mut bytes, mut frames) = (vec![0; FRAME_BYTES], 0u32);
    let [mut both, mut marked, mut seen, mut mixed] = [const { Clock(Duration::ZERO) }; 4];
    let mut camera = Camera::new(Config::default());
    let (mut grey, mut calibration, mut markers) = (plane(), Calibration::new(), None::<Markers>);
    let mut object = Tracker::new(Config::default(), Running::default());
    let (mut mixture, mut moving, mut projected) = (Mixture::default(), plane(), plane());
    let mut projection = BackProjection { histogram: vec![0; HUES * SATURATIONS] };
    let mut input = std::io::stdin().lock();
    while input.read_exact(&mut bytes).is_ok() {
        let frame = Frame::from_gbrp(&bytes).ok_or("a frame's size")?;
        let now_ms = frames * 33;
        both.time(|| camera.picture(&frame, true, now_ms, now_ms));
        frame.grey(&mut grey);
        match &mut markers {
            Some(markers) => marked.time(|| markers.follow(&grey)),
            None if calibration.frame(&grey) => markers = Some(Markers::new(&calibration)),
            None => (),
        }
        seen.time(|| object.step(&frame, &grey, &Mask::EMPTY, true));
        mixed.time(|| mixture.step(&frame, &grey, &mut moving));
        if let Some(dump) = &mut dump {
            projection.step(&frame, &moving, &mut projected);
            dump.write_all(&moving[..])?;
            dump.write_all(&projected[..])?;
        }
        frames += 1;
    }
    let rate = |clock: &Clock| f64::from(frames) / clock.0.as_secs_f64().max(1e-9);
    println!(
        "{{\"frames\": {frames}, \"markers\": {}, \"fps\": {{\"both\": {:.1}, \"markers\": {:.1}, \"object\": {:.1}, \"mixture\": {:.1}}}}}",
        markers.map_or(0, |markers| markers.len()),
        rate(&both),
        rate(&marked),
        rate(&seen),
        rate(&mixed)
    );
    Ok(())
}
