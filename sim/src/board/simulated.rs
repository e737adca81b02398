//! The host's own build of the logic, wired to a plant directly: no converter, no core. Its timing and its line are the image's, but
//! for what [`uplink`] says.

mod ahead;
pub(crate) mod downlink;
mod store;
mod uplink;

use std::time::Instant;

use tenax_hal_shim::channel::{SCAN_HZ, SCANS_PER_FRAME};
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::frame::{Frame, Scan, scan_of_pins};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_hal_shim::wire::{Answer, Identity, Restored, Up};
use tenax_scene::plant::Plant;

pub use self::ahead::Ahead;
use self::downlink::Downlink;
use self::store::Store;
use self::uplink::Uplink;
use super::kept::{Provision, Sectors};
use super::{Recorder, Run, Summary};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grips {
    Reflex(DetectorSet),
    Bound,
    /// Nobody who feels: whatever is touched is pressed with so much, N.
    Constant(f64),
}

/// Runs the plant to its end and keeps everything. `progress` is told the virtual time now and then, s.
pub fn run<P: Plant>(plant: P, progress: &mut dyn FnMut(f64)) -> (Run, P) {
    let mut run = Run::default();
    let (summary, plant) = record(plant, &mut run, progress);
    run.summary = summary;
    (run, plant)
}

/// Runs the plant to its end under the fingertip; `recorder` is told of it as it goes.
pub fn record<P: Plant>(
    mut plant: P,
    recorder: &mut dyn Recorder,
    progress: &mut dyn FnMut(f64),
) -> (Summary, P) {
    let summary = closed_loop(&mut plant, Grips::Reflex(DetectorSet::ALL), recorder, progress);
    (summary, plant)
}

pub fn run_with<P: Plant>(mut plant: P, grips: Grips, progress: &mut dyn FnMut(f64)) -> P {
    let _kept_by_the_plant = closed_loop(&mut plant, grips, &mut (), progress);
    plant
}

/// The same for every plant, or the logic would be compiled once for each: 8 s in all that runs one.
fn closed_loop(
    plant: &mut dyn Plant,
    grips: Grips,
    recorder: &mut dyn Recorder,
    progress: &mut dyn FnMut(f64),
) -> Summary {
    let began = Instant::now();
    let mut frames = frames_in(plant.duration_s());
    let provision = Provision::of(plant).expect("a plant's wearer is one");
    let mut device = provision.device();
    let mut store = Store::new(Sectors::provisioned(&provision));
    let mut summary = Summary {
        trusts_line: provision.trusts_line,
        calibrated: provision.calibrated,
        ..Summary::default()
    };
    let mut up = Uplink::new(&mut summary, recorder);
    up.post(device.start(Identity::default()));
    if device.fingertip.config().stream_at_start {
        for (kept, payload) in provision.records() {
            up.post(Up::Restored(Restored::of(kept, &payload).expect("it has room for every record")));
        }
    }
    let mut down = Downlink::default();
    device.fingertip.act_on(match grips {
        Grips::Reflex(detectors) => detectors,
        Grips::Bound | Grips::Constant(_) => DetectorSet::NONE,
    });
    let mut ahead = Ahead::default();
    let mut drive = MotorDrive::Coast;
    for sequence in 0..frames {
        up.count(down.counters(sequence));
        let select = Frame::lost(sequence).select();
        let mut scans = [Scan::default(); SCANS_PER_FRAME];
        let mut commands = down.opening();
        for scan in &mut scans {
            *scan = scan_of_pins(&plant.scan(drive).codes(), select);
            commands.extend(plant.commands().into_iter().map(|message| down.number(message)));
            down.take(&plant.line_bytes());
            up.recorder.scan(scan, drive, plant.slipping());
        }
        commands.extend(down.command(sequence));
        for command in &commands {
            up.summary.taken.push((sequence, *command));
            if let Some(message) = device.taken(command) {
                up.post(message);
            }
            let answer = device.command(command);
            if let Up::Answer { of, answer: Answer::Nonce(nonce), .. } = answer {
                down.offered(of, nonce);
            }
            up.post(answer);
        }
        device.fingertip.button(plant.button());
        let frame = Frame::from_scans(sequence, &scans);
        drive = device.tick(&frame);
        drive = match grips {
            Grips::Reflex(_) => drive,
            Grips::Bound => ahead.drive(drive, &device.fingertip, plant.planned()),
            Grips::Constant(target_n) => ahead.drive(drive, &device.fingertip, plant.closing_to(target_n)),
        };
        while let Some(message) = device.next_message() {
            up.post(message);
        }
        if let Some(message) = store.end_tick(sequence) {
            up.post(message);
        }
        if let Some((kept, payload)) = store.saved() {
            plant.keep(kept, &payload);
        }
        if plant.resets() {
            frames = sequence + 1;
            break;
        }
        if frame.slot() == slot_of(Job::Save) {
            device.slow_frame_passed();
            let duty = device.fingertip.feedback();
            plant.vibrate(duty);
            up.summary.vibrates(sequence, duty);
            if store.is_free()
                && let Some(record) = device.next_record()
            {
                store.save(record);
            }
        }
        if sequence % PROGRESS_FRAMES == 0 {
            progress(seconds_of(sequence + 1));
        }
    }
    summary.counters = down.counters(frames);
    summary.virtual_s = seconds_of(frames);
    summary.wall_s = began.elapsed().as_secs_f64();
    summary
}

/// Frames between two calls of `progress`: a tenth of a virtual second.
const PROGRESS_FRAMES: u32 = 200;

/// How long so many frames last, s.
pub(crate) fn seconds_of(frames: u32) -> f64 {
    f64::from(frames) * SCANS_PER_FRAME as f64 / f64::from(SCAN_HZ)
}

pub(crate) fn frames_in(duration_s: f64) -> u32 {
    (duration_s * f64::from(SCAN_HZ) / SCANS_PER_FRAME as f64) as u32
}
