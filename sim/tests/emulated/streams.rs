//! Telemetry only looks: what the hand does is the same without it, with all of it, and with more than the line carries.

use std::collections::BTreeSet;

use tenax_frames::link::Inbox;
use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{BAUD, Down, FRAMES_PER_RAW, Up};
use tenax_logic::setting::SettingId;
use tenax_scene::World;
use tenax_scene::plant::{Pins, Plant};
use tenax_sim::board::Run;
use tenax_sim::board::emulated::Options;
use tenax_sim::session::load_scene;

use crate::{Swing, run};

/// Somebody asks for frames and readings from the start, and for the network every so many scans.
struct Asked<P> {
    plant: P,
    streams: bool,
    network_every: Option<u32>,
    floods: bool,
    scans: u32,
}

impl<P: Plant> Asked<P> {
    fn new(plant: P, streams: bool, network_every: Option<u32>) -> Self {
        Self { plant, streams, network_every, floods: false, scans: 0 }
    }

    /// Somebody asks for more than the line carries.
    fn flooding(plant: P) -> Self {
        Self { floods: true, ..Self::new(plant, true, None) }
    }
}

impl<P: Plant> Plant for Asked<P> {
    fn within(&self) -> Option<&dyn Plant> {
        Some(&self.plant)
    }

    fn within_mut(&mut self) -> Option<&mut dyn Plant> {
        Some(&mut self.plant)
    }

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.scans += 1;
        self.plant.scan(drive)
    }

    fn commands(&mut self) -> Vec<Down> {
        let mut commands = self.plant.commands();
        if self.streams && self.scans % (10 * SCAN_HZ) == 8 {
            commands.push(Down::Stream { raw: true, senses: true, hold_s: 20 });
        }
        if self.network_every.is_some_and(|every| self.scans.is_multiple_of(every)) {
            commands.push(Down::Network);
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

/// How many messages of frames and of readings came up, and that no frame is missing between the first and the last.
fn streamed(run: &Run) -> (usize, usize) {
    let (mut inbox, mut firsts, mut senses) = (Inbox::default(), BTreeSet::new(), 0);
    let mut last = 0;
    for heard in run.line.iter().filter_map(|&byte| inbox.push(byte)).flatten() {
        if heard.missed > 0 {
            println!("{} messages are missing after frame {last}", heard.missed);
        }
        match heard.received.message {
            Up::Slow(slow) => last = slow.frame,
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
    let world = || World::new(&load_scene("pick-up-reflex").expect("a scene"), 1);
    let scene = |asked| run(asked, &Options::default());
    let off = scene(Asked::new(world(), false, None));
    let on = scene(Asked::new(world(), true, None));
    let saturated = scene(Asked::flooding(world()));
    assert!(off.drives.iter().any(|drive| *drive != MotorDrive::Coast), "something is decided");
    assert!(off.drives == on.drives && off.scans == on.scans && off.slows == on.slows);
    assert!(off.drives == saturated.drives && off.scans == saturated.scans);
    for run in [&off, &on, &saturated] {
        let counters = run.counters;
        println!("{} bytes, {} missed, {counters:?}", run.line_bytes, run.messages_missed);
        assert_eq!((counters.frames_lost, counters.overruns), (0, 0));
        // With 500 commands a second beside all of it, 2 ticks of 11,600 end a few microseconds after their frame; what they
        // decide is the same.
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

/// Everything on: no message and no frame is lost, in 10 s, or in as many as `TENAX_STREAM_S` says; 600 take one minute.
// Shows B7.
#[test]
fn a_stream_of_everything_loses_nothing() {
    let asked = std::env::var("TENAX_STREAM_S").ok();
    let seconds: u16 = asked.map_or(10, |seconds| seconds.parse().expect("TENAX_STREAM_S is a number"));
    let run = run(Asked::new(Swing::new(seconds.into()), true, Some(8_000)), &Options::default());
    println!("{} bytes, {} missed, {:?}", run.line_bytes, run.messages_missed, run.counters);
    assert_eq!((run.messages_missed, run.bad_frames, run.counters.telemetry_dropped), (0, 0, 0));
    assert_eq!((run.counters.frames_lost, run.counters.ticks_late), (0, 0));
    let (frames, senses) = streamed(&run);
    let cycles = 80 * usize::from(seconds);
    assert!(frames >= 25 * (cycles - 4) / FRAMES_PER_RAW && senses >= cycles - 4, "{frames} {senses}");
}
