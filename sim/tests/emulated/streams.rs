//! Telemetry only looks: what the hand does is the same without it, with all of it, and with more than the line carries.

use std::collections::BTreeSet;

use tenax_frames::link::Inbox;
use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{BAUD, Down, FRAMES_PER_RAW, Up};
use tenax_logic::setting::SettingId;
use tenax_scene::plant::{Pins, Plant};
use tenax_sim::board::Run;
use tenax_sim::board::emulated::Options;

use crate::{run, scene};

struct Asked<P> {
    plant: P,
    streams: bool,
    floods: bool,
    scans: u32,
}

impl<P: Plant> Plant for Asked<P> {
    tenax_scene::put_around!(plant);

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.scans += 1;
        self.plant.scan(drive)
    }

    fn commands(&mut self) -> Vec<Down> {
        let mut commands = self.plant.commands();
        if self.streams && self.scans % (10 * SCAN_HZ) == 8 {
            commands.push(Down::Stream { raw: true, senses: true, hold_s: 20 });
        }
        // As many as the board takes: of all answers, a setting's fills the line most for what it costs.
        if self.floods && self.scans.is_multiple_of(SCAN_HZ / 500) {
            commands.push(Down::Get(SettingId::S1.number()));
        }
        commands
    }

    fn streams_at_start(&self) -> bool {
        self.streams
    }
}

fn streamed(run: &Run) -> (usize, usize) {
    let (mut inbox, mut firsts, mut senses) = (Inbox::default(), BTreeSet::new(), 0);
    for heard in run.line.iter().filter_map(|&byte| inbox.push(byte)).flatten() {
        match heard.received.message {
            Up::Raw(raw) => _ = firsts.insert(raw.first),
            Up::Senses(_) => senses += 1,
            _ => {}
        }
    }
    let whole: BTreeSet<u32> = (0..).step_by(FRAMES_PER_RAW).take(firsts.len()).collect();
    assert!(run.messages_missed > 0 || firsts == whole, "a frame is missing");
    (firsts.len(), senses)
}

// Shows B7.
#[test]
fn decisions_are_the_same_without_telemetry_with_all_of_it_and_with_too_much() {
    let run = |streams, floods| {
        run(Asked { plant: scene("pick-up-reflex"), streams, floods, scans: 0 }, &Options::default())
    };
    let (off, on, saturated) = (run(false, false), run(true, false), run(true, true));
    assert!(off.drives.iter().any(|drive| *drive != MotorDrive::Coast), "something is decided");
    assert!(off.drives == on.drives && off.scans == on.scans && off.slows == on.slows);
    assert!(off.drives == saturated.drives && off.scans == saturated.scans);
    for run in [&off, &on, &saturated] {
        let counters = run.counters;
        assert_eq!((counters.frames_lost, counters.overruns), (0, 0));
        // With 500 commands a second, 2 ticks of 11,600 end a few microseconds late; what they decide is the same.
        let late = if run.messages_missed > 0 { 2 } else { 0 };
        assert!(counters.ticks_late <= late, "{counters:?}");
        assert_eq!(run.bad_frames, 0);
    }
    assert_eq!((on.counters.telemetry_dropped, on.messages_missed), (0, 0));
    // A few more come while the last messages go up the line.
    let (frames, senses) = streamed(&on);
    assert!(frames >= 12_000 / FRAMES_PER_RAW && senses >= 480, "{frames} {senses}");
    let line = on.line_bytes as f64 / on.virtual_s / f64::from(BAUD / 10);
    assert!((0.6..0.95).contains(&line), "{line} of the line");
    let dropped = u64::from(saturated.counters.telemetry_dropped);
    assert!(dropped > 50, "the line was asked for more than it carries: {dropped}");
    // What was dropped after the last counters is seen at the host only.
    assert!((dropped..dropped + 200).contains(&saturated.messages_missed), "{}", saturated.messages_missed);
}
