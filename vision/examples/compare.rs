//! Our side of `vision/compare/compare.py`: frames as raw `gbrp` come in on standard input; processor time goes out as JSON on standard
//! output, and the back projection of each frame into the file that is named, a byte a pixel.

use std::error::Error;
use std::fs::{self, File};
use std::io::{BufWriter, Read, Write};

use tenax_vision::Camera;
use tenax_vision::frame::{FRAME_BYTES, Frame, PIXELS, Plane, plane};
use tenax_vision::markers::{Calibration, Markers};
use tenax_vision::mask::Mask;
use tenax_vision::object::colour::{BINS, Bins, HUES, SATURATIONS};
use tenax_vision::object::{Config, Running};

/// Frames that one kind of work takes at once: the kernel counts processor time to some milliseconds.
const BATCH: usize = 400;
/// Back projection from which a pixel is the object's.
const OBJECT_MIN: u32 = 150;

/// Processor time of this thread until now, s.
fn processor_s() -> f64 {
    let text = fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()).unwrap_or(f64::NAN) / 1e9
}

/// The paper's way to the object (FingerVision 2017, section III), with this crate's parts: what OpenCV does beside it.
struct Paper {
    bins: Bins,
    running: Running,
    /// In halves: what moves counts half (equation 1).
    histogram: Vec<u32>,
    grey: Box<Plane>,
    bytes: Box<Plane>,
    places: Vec<u16>,
    moving: Mask,
    seen: Mask,
}

impl Paper {
    fn step(&mut self, frame: &Frame) -> u32 {
        frame.grey(&mut self.grey);
        self.running.step(&self.grey, &mut self.bytes);
        self.moving.pack(&self.bytes);
        let colours = frame.red.iter().zip(frame.green).zip(frame.blue);
        for (place, ((&red, &green), &blue)) in self.places.iter_mut().zip(colours) {
            *place = self.bins.of(red, green, blue) as u16;
        }
        // Each step of brightness has bins of its own here; the paper has one for all.
        let paper = HUES * SATURATIONS;
        let mut new = vec![0; paper];
        self.moving.for_each(|at| new[usize::from(self.places[at]) % paper] += 1);
        for (sum, new) in self.histogram.iter_mut().zip(new) {
            *sum = (*sum + new).min(2 * 255);
        }
        let is_object: [u8; BINS] =
            core::array::from_fn(|bin| u8::from(self.histogram[bin % paper] >= 2 * OBJECT_MIN));
        for (byte, &place) in self.bytes.iter_mut().zip(&self.places) {
            *byte = is_object[usize::from(place)];
        }
        self.seen.pack(&self.bytes);
        self.seen.erode(2);
        self.seen.dilate(7);
        let area = self.seen.moments().map_or(0, |moments| moments.area);
        self.moving.intersect(&self.seen);
        area + self.moving.count()
    }

    fn projected(&self) -> Vec<u8> {
        let paper = self.histogram.len();
        self.places.iter().map(|&place| (self.histogram[usize::from(place) % paper] / 2) as u8).collect()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut dump = std::env::args().nth(1).map(File::create).transpose()?.map(BufWriter::new);
    let (mut bytes, mut frames, mut checksum) = (vec![0; BATCH * FRAME_BYTES], 0, 0u64);
    let mut camera = Camera::new(Config::default());
    let (mut grey, mut calibration, mut markers) = (plane(), Calibration::new(), None::<Markers>);
    let mut paper = Paper {
        bins: Bins::new(),
        running: Running::default(),
        histogram: vec![0; HUES * SATURATIONS],
        grey: plane(),
        bytes: plane(),
        places: vec![0; PIXELS],
        moving: Mask::EMPTY,
        seen: Mask::EMPTY,
    };
    let mut spent_s = [0.0; 3];
    let mut input = std::io::stdin().lock();
    loop {
        let mut read = 0;
        while let Some(free) = bytes.get_mut(read..).filter(|free| !free.is_empty()) {
            match input.read(free)? {
                0 => break,
                more => read += more,
            }
        }
        let batch: Vec<Frame> =
            bytes[..read].chunks_exact(FRAME_BYTES).filter_map(Frame::from_gbrp).collect();
        let start_s = processor_s();
        for frame in &batch {
            frame.grey(&mut grey);
            match &mut markers {
                Some(markers) => markers.follow(&grey),
                None if calibration.frame(&grey) => markers = Some(Markers::new(&calibration)),
                None => (),
            }
        }
        let marked_s = processor_s();
        for frame in &batch {
            checksum += u64::from(paper.step(frame));
            if let Some(dump) = &mut dump {
                dump.write_all(&paper.projected())?;
            }
        }
        let seen_s = processor_s();
        for (number, frame) in (frames..).zip(&batch) {
            let now_ms = number as u32 * 33;
            checksum += u64::from(camera.picture(frame, true, now_ms, now_ms).slips());
        }
        let ends = [marked_s - start_s, seen_s - marked_s, processor_s() - seen_s];
        spent_s.iter_mut().zip(ends).for_each(|(spent, more)| *spent += more);
        frames += batch.len();
        if read < bytes.len() {
            break;
        }
    }
    let [marked, seen, all] = spent_s.map(|spent| 1e6 * spent / frames.max(1) as f64);
    println!(
        "{{\"frames\": {frames}, \"checksum\": {checksum}, \"markers\": {}, \
         \"us\": {{\"markers\": {marked:.1}, \"object\": {seen:.1}, \"camera\": {all:.1}}}}}",
        markers.map_or(0, |markers| markers.len()),
    );
    Ok(())
}
