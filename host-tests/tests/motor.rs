//! The motor's limits: a grasp at the force ceiling for a quarter of an hour, a wearer who goes on closing, cut wires.

use tenax_hal_shim::channel::{MOTOR_CURRENT, OPENING};
use tenax_hal_shim::front_end::MOTOR_MV_PER_A;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{DriveSource, Fault, MotorStop, Reason};
use tenax_host_tests::{Bench, rests};
use tenax_logic::detectors::Said;

const FRAME_S: f64 = 1.0 / 2_000.0;
const FRAMES_PER_S: u32 = 2_000;
/// Voltage of current and opening at nothing, mV.
const ZERO_MV: f64 = 300.0;

/// A finger on a spring of 3 N/mm, driven by the gripper of the scenes: 120 mm/s, 140 N, 1 A when blocked.
struct Hand {
    bench: Bench,
    opening_mm: f64,
    width_mm: f64,
    driven_frames: u32,
}

impl Hand {
    fn new(seed: u64) -> Self {
        let mut bench = Bench::new(seed);
        bench.run(400);
        Self { bench, opening_mm: 68.0, width_mm: 70.0, driven_frames: 0 }
    }

    fn force_n(&self) -> f64 {
        (3.0 * (self.width_mm - self.opening_mm) / 2.0).max(0.0)
    }

    fn step(&mut self) -> MotorDrive {
        let drive = self.bench.step();
        let part = |duty: Duty| f64::from(duty.as_per_mille()) / 1e3;
        let load = self.force_n() / 140.0;
        let (speed, current_a) = match drive {
            MotorDrive::Coast => (0.0, 0.0),
            MotorDrive::Close(duty) => {
                let speed = (part(duty) - load).max(0.0);
                (-speed, part(duty) * (part(duty) - speed))
            }
            MotorDrive::Open(duty) => (part(duty), 0.0),
        };
        self.driven_frames += u32::from(drive != MotorDrive::Coast);
        self.opening_mm = (self.opening_mm + speed * 120.0 * FRAME_S).clamp(0.0, 100.0);
        self.bench.pins_mv[OPENING] = ZERO_MV + 24.0 * self.opening_mm;
        self.bench.pins_mv[MOTOR_CURRENT] = ZERO_MV + f64::from(MOTOR_MV_PER_A) * current_a;
        let force_n = self.force_n();
        self.bench.load(force_n, 0.4 * force_n);
        self.bench.slows.clear();
        drive
    }

    fn run(&mut self, seconds: u32) -> Vec<MotorDrive> {
        (0..seconds * FRAMES_PER_S).map(|_| self.step()).collect()
    }

    fn stops(&self) -> Vec<Option<MotorStop>> {
        let stop = |kind| if let EventKind::Motor(stop) = kind { Some(stop) } else { None };
        self.bench.kinds().filter_map(stop).collect()
    }
}

// Shows B9.
#[test]
fn a_grasp_at_the_ceiling_for_a_quarter_of_an_hour_stops_no_motor() {
    // The object gives way by 2 N a second and slip is reported all the time: the reflex closes up to the ceiling. The winding's
    // heat settles within seconds.
    let mut hand = Hand::new(71);
    let mut most_n: f64 = 0.0;
    for frame in 0..900 * FRAMES_PER_S {
        hand.bench.fingertip.inject(Said::slip(frame > 4 * FRAMES_PER_S));
        if hand.width_mm > 20.0 {
            hand.width_mm -= 2.0 / 1.5 * FRAME_S;
        }
        if hand.width_mm <= 20.0 {
            // Another one, as wide as the first.
            (hand.width_mm, hand.opening_mm) = (hand.width_mm + 50.0, hand.opening_mm + 50.0);
        }
        hand.step();
        most_n = most_n.max(hand.force_n());
    }
    let driven_s = f64::from(hand.driven_frames) * FRAME_S;
    assert!(driven_s > 15.0 && most_n > 39.0, "the control: driven for {driven_s} s, up to {most_n} N");
    assert_eq!(hand.stops(), []);
}

// Shows W2, B9.
#[test]
fn a_wearer_who_goes_on_closing_is_stopped_keeps_the_object_and_opens_at_once() {
    let mut hand = Hand::new(72);
    hand.run(1);
    hand.bench.muscles(900.0, 95.0);
    hand.run(6);
    assert_eq!(hand.stops(), [Some(MotorStop::ClosingStalled)]);
    let (held_n, driven) = (hand.force_n(), hand.driven_frames);
    assert!(held_n > 60.0, "the control: {held_n} N");
    assert!(hand.run(20).iter().all(|drive| !drive.opens()));
    // A contraction fluctuates: a stronger one may try again.
    assert!(hand.driven_frames - driven < 2 * FRAMES_PER_S, "{} frames", hand.driven_frames - driven);
    assert!(hand.force_n() >= held_n, "nothing is let go");

    hand.bench.muscles(50.0, 800.0);
    let frames = hand.run(1).iter().position(|drive| drive.opens());
    assert!(frames.is_some_and(|frames| frames < 100), "{frames:?} frames");
    hand.run(2);
    // An opening that both electrodes do not prove is short.
    assert!(hand.force_n() < held_n - 1.0, "{} N", hand.force_n());
    assert_eq!(hand.stops().last(), Some(&None), "the end of the stop is told");
}

// Shows W1, B9.
#[test]
fn a_stopped_motor_is_driven_by_nobody() {
    let mut bench = Bench::new(73);
    bench.run(400);
    bench.slows.clear();
    bench.muscles(900.0, 95.0);
    for _ in 0..6 * FRAMES_PER_S {
        // Jammed: nothing moves.
        let part =
            if let MotorDrive::Close(duty) = bench.step() { f64::from(duty.as_per_mille()) } else { 0.0 };
        bench.pins_mv[MOTOR_CURRENT] = ZERO_MV + f64::from(MOTOR_MV_PER_A) * (part / 1e3).powi(2);
    }
    assert!(
        bench
            .ticks()
            .all(|tick| { (tick.drive == MotorDrive::Coast) == (tick.source == DriveSource::Nobody) })
    );
    let driven = bench.ticks().filter(|tick| tick.drive.closes()).count();
    assert!((400..1_000).contains(&driven), "{driven} frames");
}

// Shows R5, B10.
#[test]
fn a_cut_wire_of_current_or_opening_is_told_within_50_ms_and_opens_nothing() {
    for channel in [OPENING, MOTOR_CURRENT] {
        let mut bench = Bench::holding(74);
        let cut_at = bench.frames;
        bench.pins_mv[channel] = 0.0;
        assert!(rests(&bench.run(400)));
        let lost = bench.lost(channel);
        let in_time = matches!(lost[..], [(frame, Reason::Dead), ..] if frame - cut_at <= 100);
        assert!(in_time, "{channel}: {lost:?}");
        bench.pins_mv[channel] = ZERO_MV;
        bench.run(4_000);
        assert!(bench.count(EventKind::Fault(Fault::SensorBack { channel: channel as u8 })) > 0);
    }
}
