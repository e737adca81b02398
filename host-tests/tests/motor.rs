//! What the motor bears: a grasp at the force ceiling for an hour, and a wearer who goes on closing.

use tenax_hal_shim::channel::{MOTOR_CURRENT, OPENING};
use tenax_hal_shim::front_end::MOTOR_MV_PER_A;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{DriveSource, Fault, MotorStop, Reason};
use tenax_host_tests::Bench;
use tenax_logic::detectors::Said;

const FRAME_S: f64 = 1.0 / 2_000.0;
const FRAMES_PER_S: u32 = 2_000;

/// A finger's force on a spring of 3 N/mm, by the gripper of the scenes: 120 mm/s, 140 N, 1 A when it is blocked.
struct Hand {
    bench: Bench,
    opening_mm: f64,
    width_mm: f64,
    drives: u32,
}

impl Hand {
    fn new(seed: u64) -> Self {
        let mut bench = Bench::new(seed);
        bench.run(400);
        Self { bench, opening_mm: 68.0, width_mm: 70.0, drives: 0 }
    }

    fn force_n(&self) -> f64 {
        (3.0 * (self.width_mm - self.opening_mm) / 2.0).max(0.0)
    }

    fn step(&mut self) -> MotorDrive {
        let drive = self.bench.step();
        let duty = |duty: Duty| f64::from(duty.as_per_mille()) / 1e3;
        let load = self.force_n() / 140.0;
        let (speed, current) = match drive {
            MotorDrive::Coast => (0.0, 0.0),
            MotorDrive::Close(by) => {
                let speed = (duty(by) - load).max(0.0);
                (-speed, duty(by) * (duty(by) - speed))
            }
            MotorDrive::Open(by) => (duty(by), 0.0),
        };
        self.drives += u32::from(drive != MotorDrive::Coast);
        self.opening_mm = (self.opening_mm + speed * 120.0 * FRAME_S).clamp(0.0, 100.0);
        self.bench.pins_mv[OPENING] = 300.0 + 24.0 * self.opening_mm;
        self.bench.pins_mv[MOTOR_CURRENT] = 300.0 + f64::from(MOTOR_MV_PER_A) * current;
        let force_n = self.force_n();
        self.bench.load(force_n, 0.4 * force_n);
        self.bench.slows.clear();
        drive
    }

    fn stops(&self) -> Vec<Option<MotorStop>> {
        let stop = |kind: &EventKind| if let EventKind::Motor(stop) = *kind { Some(stop) } else { None };
        self.bench.events.iter().filter_map(|event| stop(&event.kind)).collect()
    }
}

// Shows B9.
#[test]
fn a_grasp_at_the_ceiling_for_a_quarter_of_an_hour_stops_no_motor() {
    // What is held gives way by 2 N a second, and slips for ever as far as anybody knows: the reflex closes up to the ceiling all
    // the time. The winding's heat settles within seconds.
    let mut hand = Hand::new(71);
    let mut most_n: f64 = 0.0;
    for frame in 0..900 * FRAMES_PER_S {
        hand.bench.fingertip.inject(Said::slip(frame > 4 * FRAMES_PER_S));
        hand.width_mm -= 2.0 / 1.5 * FRAME_S * f64::from(u8::from(hand.width_mm > 20.0));
        if hand.width_mm <= 20.0 {
            // Another one, as wide as the first.
            (hand.width_mm, hand.opening_mm) = (hand.width_mm + 50.0, hand.opening_mm + 50.0);
        }
        hand.step();
        most_n = most_n.max(hand.force_n());
    }
    let driven_s = f64::from(hand.drives) * FRAME_S;
    println!("driven for {driven_s:.0} s of the quarter, up to {most_n:.1} N");
    assert!(driven_s > 15.0 && most_n > 39.0, "the control: {driven_s} s, {most_n} N");
    assert_eq!(hand.stops(), []);
}

// Shows W2, B9.
#[test]
fn a_wearer_who_goes_on_closing_is_stopped_keeps_what_is_held_and_opens_at_once() {
    let mut hand = Hand::new(72);
    (0..FRAMES_PER_S).for_each(|_| _ = hand.step());
    hand.bench.muscles(900.0, 95.0);
    (0..6 * FRAMES_PER_S).for_each(|_| _ = hand.step());
    assert_eq!(hand.stops(), [Some(MotorStop::ClosingStalled)]);
    let (held_n, driven) = (hand.force_n(), hand.drives);
    assert!(held_n > 60.0, "the control: {held_n} N");
    (0..20 * FRAMES_PER_S).for_each(|_| {
        let drive = hand.step();
        assert!(!drive.opens());
    });
    // A contraction fluctuates: a stronger one may try again.
    assert!(hand.drives - driven < 2 * FRAMES_PER_S, "{} frames", hand.drives - driven);
    assert!(hand.force_n() >= held_n, "nothing is let go");

    hand.bench.muscles(50.0, 800.0);
    let frames = (0..FRAMES_PER_S).position(|_| hand.step().opens());
    assert!(frames.is_some_and(|frames| frames < 100), "{frames:?} frames");
    (0..2 * FRAMES_PER_S).for_each(|_| _ = hand.step());
    assert!(
        hand.force_n() < held_n - 1.0,
        "an opening that both electrodes do not prove is short: {} N",
        hand.force_n()
    );
    assert_eq!(hand.stops().last(), Some(&None), "told");
}

// Shows W1, B9.
#[test]
fn what_stops_the_motor_is_nobodys_drive() {
    let mut hand = Hand::new(73);
    hand.bench.muscles(900.0, 95.0);
    let mut sources = Vec::new();
    for _ in 0..6 * FRAMES_PER_S {
        let drive = hand.bench.step();
        sources.extend(
            hand.bench.slows.drain(..).flat_map(|slow| slow.ticks).map(|tick| (tick.drive, tick.source)),
        );
        // Jammed: nothing moves.
        let duty =
            if let MotorDrive::Close(duty) = drive { f64::from(duty.as_per_mille()) / 1e3 } else { 0.0 };
        hand.bench.pins_mv[MOTOR_CURRENT] = 300.0 + f64::from(MOTOR_MV_PER_A) * duty * duty;
    }
    let coasts = |&(drive, source): &(MotorDrive, DriveSource)| {
        (drive == MotorDrive::Coast) == (source == DriveSource::Nobody)
    };
    assert!(sources.iter().all(coasts));
    let driven = sources.iter().filter(|(drive, _)| drive.closes()).count();
    assert!((400..1_000).contains(&driven), "{driven} frames");
}

// Shows R5, B10.
#[test]
fn a_cut_wire_of_current_or_opening_is_told_within_50_ms_and_opens_nothing() {
    for channel in [OPENING, MOTOR_CURRENT] {
        let mut bench = Bench::holding(74);
        let cut_at = bench.frames;
        bench.pins_mv[channel] = 0.0;
        assert!(bench.run(400).iter().all(|drive| *drive == MotorDrive::Coast));
        let lost = EventKind::Fault(Fault::SensorLost { channel: channel as u8, reason: Reason::Dead });
        let told = bench.events.iter().find(|event| event.kind == lost).map(|event| event.frame - cut_at);
        assert!(told.is_some_and(|frames| frames <= 100), "{channel}: {told:?} frames");
        bench.pins_mv[channel] = 300.0;
        bench.run(4_000);
        let back = EventKind::Fault(Fault::SensorBack { channel: channel as u8 });
        assert!(bench.events.iter().any(|event| event.kind == back));
    }
}
