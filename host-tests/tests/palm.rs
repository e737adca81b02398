//! The contract with the wearer, where a palm wishes for force: as a warning of the finger's own, and never more.

use tenax_hal_shim::channel::FSR;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Up, encode};
use tenax_host_tests::Bench;
use tenax_palm::bus::{FRAME_MAX, Packet, Poll, Word};
use tenax_palm::finger::Finger;

const CHIP: [u32; 3] = [1, 2, 3];

/// A fingertip on a bench, with a palm that wishes for a load.
struct Wished {
    bench: Bench,
    end: Finger,
    number: u16,
    want_mn: Option<u16>,
    is_polled: bool,
}

impl Wished {
    fn new(bench: Bench) -> Self {
        let mut wished = Self { bench, end: Finger::new(CHIP), number: 0, want_mn: None, is_polled: true };
        // It tells its number when it is asked who has no address, and has one then.
        let mut out = [0; FRAME_MAX];
        let claim =
            encode(0, &Packet { address: 0, word: Word::Claim { round: 1, slots: 1 } }, &mut [0; FRAME_MAX])
                .unwrap()
                .to_vec();
        let answer = claim.iter().find_map(|&byte| wished.end.hear(byte, 0, &mut out)).unwrap();
        let mut receiver = tenax_hal_shim::wire::Receiver::new();
        let here =
            out[..answer.length].iter().find_map(|&byte| receiver.push::<Packet>(byte)).unwrap().unwrap();
        let Word::Here { chip, nonce } = here.message.word else { unreachable!() };
        wished.say(1, Word::Assign { chip, nonce }, 0);
        assert_eq!(wished.end.address(), 1);
        wished
    }

    fn say(&mut self, address: u8, word: Word, now_us: u32) {
        let frame = encode(self.number, &Packet { address, word }, &mut [0; FRAME_MAX]).unwrap().to_vec();
        self.number += 1;
        frame.iter().for_each(|&byte| _ = self.end.hear(byte, now_us, &mut [0; FRAME_MAX]));
    }

    /// So many frames, a poll every fourth; in how many of them the motor closed.
    fn run(&mut self, frames: u32) -> u32 {
        let mut closed = 0;
        for _ in 0..frames {
            let now_us = self.bench.frames * 500;
            if self.is_polled && self.bench.frames.is_multiple_of(4) {
                let poll = Poll { stamp_us: now_us, want_mn: self.want_mn, ..Poll::default() };
                self.say(1, Word::Poll(poll), now_us);
            }
            let drive = self.bench.step();
            assert!(!drive.opens());
            closed += u32::from(drive.closes());
            self.bench.slows.drain(..).for_each(|slow| self.end.note(&Up::Slow(slow)));
            self.end.ticked(&mut self.bench.fingertip, now_us);
        }
        closed
    }

    /// Holds 4 N, and the palm has been there for a while.
    fn holding() -> Self {
        let mut wished = Self::new(Bench::holding(1));
        assert_eq!(wished.run(400), 0, "nothing was wished");
        wished
    }
}

// Shows L7.
#[test]
fn a_wish_closes_in_pulses_until_its_budget_is_spent_and_a_muscle_renews_it() {
    let mut wished = Wished::holding();
    wished.want_mn = Some(30_000);
    // The worst that a palm can ask for, where each pulse raises a little.
    let closes = |wished: &mut Wished| {
        (0..100)
            .map(|n| {
                wished.bench.load(4.0 + f64::from(n) * 0.1, 0.8);
                wished.run(400)
            })
            .sum::<u32>()
    };
    let closed = closes(&mut wished);
    assert!((350..=460).contains(&closed), "{closed} frames");
    assert_eq!(closes(&mut wished), 0, "its budget is spent");
    wished.bench.muscles(400.0, 0.0);
    wished.run(1_000);
    wished.bench.muscles(0.0, 0.0);
    wished.run(1_000);
    assert!(closes(&mut wished) > 0);
}

// Shows L7.
#[test]
fn a_wish_that_comes_and_goes_spends_the_same_budget() {
    let mut wished = Wished::holding();
    let mut closed = 0;
    for n in 0..40_000 {
        if n % 400 == 0 {
            wished.bench.load(4.0 + f64::from(n) / 4_000.0, 0.8);
        }
        // One poll in ten wishes.
        wished.want_mn = (n / 4 % 10 == 0).then_some(30_000);
        closed += wished.run(1);
    }
    assert!((200..=460).contains(&closed), "{closed} frames");
}

// Shows L7.
#[test]
fn a_force_sensor_that_comes_and_goes_renews_nothing() {
    let mut wished = Wished::holding();
    wished.want_mn = Some(30_000);
    let closed: u32 = (0..60)
        .map(|n| {
            wished.bench.load(4.0 + f64::from(n) * 0.1, 0.8);
            let closed = wished.run(2_400);
            wished.bench.pins_mv[FSR + 1] = 0.0;
            closed + wished.run(100)
        })
        .sum();
    assert!((200..=460).contains(&closed), "{closed} frames");
}

#[test]
fn pulses_that_raise_nothing_end_and_leave_the_fingers_own_warnings_answered() {
    let mut wished = Wished::holding();
    wished.want_mn = Some(30_000);
    let closed = wished.run(20_000);
    assert!((1..=4 * 40).contains(&closed), "{closed} frames");
    assert_eq!(wished.run(20_000), 0);
    // Shear that S2 warns of, at the same load.
    wished.bench.load(4.0, 1.4);
    assert!(wished.run(1_000) > 0);
}

// Shows L7, R2.
#[test]
fn nothing_is_closed_by_a_wish_that_is_met_above_the_ceiling_or_of_an_empty_hand() {
    let mut wished = Wished::holding();
    wished.want_mn = Some(3_900);
    assert_eq!(wished.run(4_000), 0, "met");
    wished.bench.load(45.0, 4.5);
    wished.run(100);
    wished.want_mn = Some(60_000);
    assert_eq!(wished.run(4_000), 0, "above the ceiling");
    wished.bench.load(0.0, 0.0);
    wished.run(400);
    assert_eq!(wished.run(4_000), 0, "empty");
}

// Shows L7, W1.
#[test]
fn while_a_muscle_is_active_a_wish_moves_nothing() {
    let mut wished = Wished::holding();
    // Opens a little less than it would have to.
    wished.bench.muscles(0.0, 150.0);
    wished.want_mn = Some(30_000);
    for _ in 0..4_000 {
        let closed = wished.run(1);
        assert!(closed == 0 || !wished.bench.fingertip.wearer_active());
    }
    wished.bench.muscles(400.0, 400.0);
    wished.run(400);
    assert!(wished.bench.fingertip.wearer_active());
    assert_eq!(wished.run(2_000), 0, "both are active");
    wished.bench.muscles(0.0, 0.0);
    assert!(wished.run(4_000) > 0, "the control");
}

#[test]
fn a_palm_that_falls_silent_wishes_nothing_after_eight_milliseconds() {
    let mut wished = Wished::holding();
    wished.want_mn = Some(30_000);
    assert!(wished.run(200) > 0);
    wished.is_polled = false;
    // A pulse that has begun ends as its settings say.
    wished.run(16 + 60);
    assert_eq!(wished.run(4_000), 0);
    wished.is_polled = true;
    assert_eq!(wished.run(100), 0, "after 100 ms it has no address any more");
    assert_eq!(wished.bench.step(), MotorDrive::Coast);
}
