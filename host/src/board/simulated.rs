//! The host's own build of the logic, wired to a plant directly: no converter, no line, no core.
//!
//! Its timing is the image's: what a frame decides drives the plant from the next scan on.

use std::time::Instant;

use tenax_hal_shim::channel::{SCAN_HZ, SCANS_PER_FRAME};
use tenax_hal_shim::frame::{Frame, Scan, scan_of_pins};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Counters, Received, Up};
use tenax_logic::device::Device;
use tenax_scene::plant::Plant;

use super::Run;

/// Who says that the object slips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Judge {
    /// The fingertip's own detectors.
    Detectors,
    /// The plant, which knows: the oracle's.
    Plant,
}

/// Runs the plant to its end under the fingertip.
///
/// `progress` is told the virtual time now and then, s.
pub fn run<P: Plant>(plant: P, progress: &mut dyn FnMut(f64)) -> (Run, P) {
    closed_loop(plant, Judge::Detectors, progress)
}

/// Runs the plant to its end under the same fingertip, which is told in each tick whether the object slips, with no
/// delay: the physical limit of that gripper.
pub fn run_oracle<P: Plant>(plant: P, progress: &mut dyn FnMut(f64)) -> (Run, P) {
    closed_loop(plant, Judge::Plant, progress)
}

fn closed_loop<P: Plant>(mut plant: P, judge: Judge, progress: &mut dyn FnMut(f64)) -> (Run, P) {
    let began = Instant::now();
    let frames = frames_in(plant.duration_s());
    let mut run = Run { starts: vec![None], ..Run::default() };
    let mut device = Device::default();
    let mut drive = MotorDrive::Coast;
    for sequence in 0..frames {
        let select = Frame::lost(sequence).select();
        let mut scans = [Scan::default(); SCANS_PER_FRAME];
        let mut commands = Vec::new();
        for scan in &mut scans {
            *scan = scan_of_pins(&plant.scan(drive).codes(), select);
            commands.extend(plant.commands());
            run.drives.push(drive);
            run.slipping.push(plant.slipping());
        }
        run.scans.extend(scans);
        for command in &commands {
            let of = run.taken.len() as u16;
            run.taken.push((sequence, *command));
            take(device.command(&Received { sequence: of, message: *command }), &mut run);
        }
        let frame = Frame::from_scans(sequence, &scans);
        drive = match judge {
            Judge::Detectors => device.tick(&frame),
            Judge::Plant => device.fingertip_mut().tick_told(&frame, plant.slipping()),
        };
        std::iter::from_fn(|| device.next_message()).for_each(|message| take(message, &mut run));
        if sequence % PROGRESS_FRAMES == 0 {
            progress(seconds(run.scans.len()));
        }
    }
    run.counters = Counters { frames, ticks: frames, ..Counters::default() };
    run.virtual_s = seconds(run.scans.len());
    run.wall_s = began.elapsed().as_secs_f64();
    (run, plant)
}

/// Frames between two calls of `progress`: a tenth of a virtual second.
const PROGRESS_FRAMES: u32 = 200;

fn take(message: Up, run: &mut Run) {
    match message {
        Up::Slow(slow) => run.slows.push(slow),
        Up::Event(event) => run.events.push(event),
        Up::Answer { of, answer, .. } => run.answers.push((of, answer)),
        // What a board says of its start, its store and its counts: there is none here.
        Up::Hello { .. } | Up::Counters(_) | Up::Saved { .. } => {}
    }
}

fn seconds(scans: usize) -> f64 {
    scans as f64 / f64::from(SCAN_HZ)
}

/// Whole frames in `duration_s`.
pub(super) fn frames_in(duration_s: f64) -> u32 {
    (duration_s * f64::from(SCAN_HZ) / SCANS_PER_FRAME as f64) as u32
}
