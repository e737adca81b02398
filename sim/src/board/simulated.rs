//! The host's own build of the logic, wired to a plant directly: no converter, no core. Its timing and its line are the image's, but
//! for what [`uplink`] says.

mod ahead;
pub(crate) mod downlink;
mod store;
mod uplink;

use tenax_hal_shim::channel::{SCAN_HZ, SCANS_PER_FRAME};
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::frame::{Frame, Scan, scan_of_pins};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_hal_shim::wire::{Answer, Identity, Restored, Up};
use tenax_logic::device::Device;
use tenax_logic::fingertip::Fingertip;
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

/// Runs the plant to its end and keeps everything.
pub fn run<P: Plant>(plant: P) -> (Run, P) {
    let mut run = Run::default();
    let (summary, plant) = record(plant, Grips::Reflex(DetectorSet::ALL), &mut run, &mut |_| {});
    run.summary = summary;
    (run, plant)
}

/// Runs the plant to its end; `recorder` is told of it as it goes, `progress` the virtual time now and then, s.
pub fn record<P: Plant>(
    mut plant: P,
    grips: Grips,
    recorder: &mut dyn Recorder,
    progress: &mut dyn FnMut(f64),
) -> (Summary, P) {
    let summary = closed_loop(&mut plant, grips, recorder, progress, &mut |own, _, _| own);
    (summary, plant)
}

/// `choose` has the last word about the drive, beside a hand without a reflex.
pub fn run_chosen<P: Plant>(mut plant: P, choose: &mut Choose<'_>) -> P {
    let nobody = Grips::Reflex(DetectorSet::NONE);
    let _kept_by_the_plant = closed_loop(&mut plant, nobody, &mut (), &mut |_| {}, choose);
    plant
}

/// The same for every plant, or the logic would be compiled once for each: 8 s in all that runs one.
fn closed_loop(
    plant: &mut dyn Plant,
    grips: Grips,
    recorder: &mut dyn Recorder,
    progress: &mut dyn FnMut(f64),
    choose: &mut Choose<'_>,
) -> Summary {
    let mut board = Stepper::new(plant, grips, recorder);
    for frame in 0..frames_in(plant.duration_s()) {
        if !board.frame_with(plant, recorder, choose) {
            break;
        }
        if frame % PROGRESS_FRAMES == 0 {
            progress(seconds_of(frame + 1));
        }
    }
    board.end()
}

/// The drive of the next frame, by the logic's own.
pub type Choose<'a> = dyn FnMut(MotorDrive, &Fingertip, &dyn Plant) -> MotorDrive + 'a;

/// The board between two frames.
pub struct Stepper {
    pub device: Device,
    store: Store,
    up: Uplink,
    down: Downlink,
    frames: u32,
    drive: MotorDrive,
    grips: Grips,
    ahead: Ahead,
}

impl Stepper {
    pub fn new(plant: &dyn Plant, grips: Grips, recorder: &mut dyn Recorder) -> Self {
        let provision = Provision::of(plant).expect("a plant's wearer is one");
        let mut device = provision.device();
        let summary = Summary {
            trusts_line: provision.trusts_line,
            calibrated: provision.calibrated,
            ..Summary::default()
        };
        let mut up = Uplink::new(summary, recorder);
        up.post(device.start(Identity::default()), recorder);
        if device.fingertip.config().stream_at_start {
            for (kept, payload) in provision.records() {
                let restored = Restored::of(kept, &payload).expect("it has room for every record");
                up.post(Up::Restored(restored), recorder);
            }
        }
        device.fingertip.act_on(match grips {
            Grips::Reflex(detectors) => detectors,
            Grips::Bound | Grips::Constant(_) => DetectorSet::NONE,
        });
        Self {
            device,
            store: Store::new(Sectors::provisioned(&provision)),
            up,
            down: Downlink::default(),
            frames: 0,
            drive: MotorDrive::Coast,
            grips,
            ahead: Ahead::default(),
        }
    }

    /// Goes on by a frame. False: the board was reset.
    pub fn frame(&mut self, plant: &mut dyn Plant, recorder: &mut dyn Recorder) -> bool {
        self.frame_with(plant, recorder, &mut |own, _, _| own)
    }

    /// As [`Stepper::frame`]; `choose` has the last word about the drive.
    pub fn frame_with(
        &mut self,
        plant: &mut dyn Plant,
        recorder: &mut dyn Recorder,
        choose: &mut Choose<'_>,
    ) -> bool {
        let Self { device, store, up, down, ahead, .. } = self;
        let sequence = self.frames;
        up.count(down.counters(sequence), recorder);
        let select = Frame::lost(sequence).select();
        let mut scans = [Scan::default(); SCANS_PER_FRAME];
        let mut commands = down.opening();
        for scan in &mut scans {
            *scan = scan_of_pins(&plant.scan(self.drive).codes(), select);
            commands.extend(plant.commands().into_iter().map(|message| down.number(message)));
            down.take(&plant.line_bytes());
            recorder.scan(scan, self.drive);
        }
        commands.extend(down.command(sequence));
        for command in &commands {
            up.summary.taken.push((sequence, *command));
            if let Some(message) = device.taken(command) {
                up.post(message, recorder);
            }
            let answer = device.command(command);
            if let Up::Answer { of, answer: Answer::Nonce(nonce), .. } = answer {
                down.offered(of, nonce);
            }
            up.post(answer, recorder);
        }
        device.fingertip.button(plant.button());
        let frame = Frame::from_scans(sequence, &scans);
        let own = device.tick(&frame);
        let fingertip = &device.fingertip;
        self.drive = match self.grips {
            Grips::Reflex(_) => choose(own, fingertip, plant),
            Grips::Bound => ahead.drive(own, fingertip, plant.planned()),
            Grips::Constant(target_n) => ahead.drive(own, fingertip, plant.closing_to(target_n)),
        };
        while let Some(message) = device.next_message() {
            up.post(message, recorder);
        }
        if let Some(message) = store.end_tick(sequence) {
            up.post(message, recorder);
        }
        if let Some((kept, payload)) = store.saved() {
            plant.keep(kept, &payload);
        }
        self.frames += 1;
        if plant.resets() {
            return false;
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
        true
    }

    pub const fn drive(&self) -> MotorDrive {
        self.drive
    }

    pub fn end(mut self) -> Summary {
        self.up.summary.counters = self.down.counters(self.frames);
        self.up.summary.virtual_s = seconds_of(self.frames);
        self.up.summary
    }
}

/// Frames between two calls of `progress`: a tenth of a virtual second.
const PROGRESS_FRAMES: u32 = 200;

/// How long so many frames last, s.
pub fn seconds_of(frames: u32) -> f64 {
    f64::from(frames) * SCANS_PER_FRAME as f64 / f64::from(SCAN_HZ)
}

pub fn frames_in(duration_s: f64) -> u32 {
    (duration_s * f64::from(SCAN_HZ) / SCANS_PER_FRAME as f64) as u32
}
