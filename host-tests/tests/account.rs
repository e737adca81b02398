//! The account of motion without a proof: one budget for all faults of an electrode, and no real contraction is starved.

use tenax_hal_shim::channel::{FSR, MYO_EXTENSOR, MYO_FLEXOR};
use tenax_hal_shim::front_end::MYO_REST_MV;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{Fault, Reason};
use tenax_host_tests::{Bench, closing_frames, opened_mm, opens};
use tenax_logic::account::{Account, CLOSES_AT_MOST, OPENS_AT_MOST};
use tenax_logic::config::Config;
use tenax_logic::emg::Verdict;
use tenax_logic::emg::decide::Wish;
use tenax_logic::gate::Gate;

const SEEDS: std::ops::Range<u64> = 31..34;
/// Largest opening by faults of an electrode, mm, and longest closing, frames.
const SAFE_MM: f64 = 0.75;
const SAFE_FRAMES: usize = 184;
/// The least opening of a contraction of 2 s at 900 mV, mm: 0.9 s at the full 120 mm/s.
const OPENS_MM: f64 = 110.0;
const RESTS_MV: f64 = 50.0;

/// Lifts of 0.3 s to 900 mV, one every 5 s.
fn lifts(bench: &mut Bench, pin: usize, count: usize) -> Vec<MotorDrive> {
    let mut drives = Vec::new();
    for _ in 0..count {
        bench.lift(pin, 900.0);
        drives.extend(bench.run(600));
        bench.lift(pin, RESTS_MV);
        bench.lifted = None;
        drives.extend(bench.run(9_400));
    }
    drives
}

/// A contraction of 2 s and 2 s of rest. The other pin stays as it is. Gives the opening, mm.
fn contract(bench: &mut Bench, pin: usize, mv: f64) -> f64 {
    bench.pins_mv[pin] = f64::from(MYO_REST_MV) + mv;
    let mm = opened_mm(&bench.run(4_000));
    bench.pins_mv[pin] = f64::from(MYO_REST_MV) + RESTS_MV;
    bench.run(4_000);
    mm
}

// Shows W4, W5.
#[test]
fn twenty_lifts_of_an_electrode_spend_one_budget_and_are_told_once() {
    for (seed, pin) in SEEDS.flat_map(|seed| [(seed, MYO_FLEXOR), (seed, MYO_EXTENSOR)]) {
        let mut bench = Bench::holding(seed);
        let drives = lifts(&mut bench, pin, 20);
        let (mm, closes) = (opened_mm(&drives), closing_frames(&drives));
        assert!(mm <= SAFE_MM && closes <= SAFE_FRAMES, "seed {seed}, pin {pin}: {mm} mm, {closes} frames");
        assert!(mm > 0.0 || closes > 0, "a fault that moves nothing shows nothing");
        assert!(matches!(bench.lost(pin)[..], [(_, Reason::NoContact)]), "{:?}", bench.lost(pin));
    }
}

// Shows W3.
#[test]
fn an_opening_after_lifts_is_answered_at_once_and_takes_the_report_back() {
    for seed in SEEDS {
        let mut bench = Bench::holding(seed);
        lifts(&mut bench, MYO_EXTENSOR, 5);
        bench.muscles(RESTS_MV, 900.0);
        assert!(opens(&bench.run(50)), "seed {seed}");
        let mm = opened_mm(&bench.run(3_950));
        assert!(mm > OPENS_MM, "seed {seed}: {mm} mm");
        assert_eq!(bench.count(EventKind::Fault(Fault::SensorBack { channel: MYO_EXTENSOR as u8 })), 1);
    }
}

// Shows W3, W5.
#[test]
fn every_opening_beside_a_dead_flexor_opens_as_with_a_sound_one() {
    for (seed, dead) in SEEDS.flat_map(|seed| [(seed, false), (seed, true)]) {
        let mut bench = Bench::holding(seed);
        if dead {
            bench.pins_mv[MYO_FLEXOR] = 0.0;
            bench.run(2_000);
        }
        for n in 0..10 {
            let mm = contract(&mut bench, MYO_EXTENSOR, 900.0);
            assert!(mm > OPENS_MM, "seed {seed}, dead {dead}, opening {n}: {mm} mm");
        }
    }
}

// Shows W3, W5.
#[test]
fn an_extensor_that_is_seated_again_during_a_contraction_opens_with_it_and_with_the_next_one() {
    for (seed, off_mv) in
        SEEDS.flat_map(|seed| [-300.0, 90.0, 400.0, 1_000.0, 1_500.0, 2_500.0].map(|mv| (seed, mv)))
    {
        let mut bench = Bench::holding(seed);
        bench.lift(MYO_EXTENSOR, off_mv);
        bench.run(10_000);
        bench.lifted = None;
        bench.muscles(RESTS_MV, 1_000.0);
        let held_mm = opened_mm(&bench.run(12_000));
        bench.muscles(RESTS_MV, RESTS_MV);
        bench.run(4_000);
        let next_mm = contract(&mut bench, MYO_EXTENSOR, 900.0);
        assert!(held_mm > OPENS_MM, "seed {seed}, lifted at {off_mv} mV: {held_mm} mm");
        assert!(next_mm > OPENS_MM, "seed {seed}, lifted at {off_mv} mV: then {next_mm} mm");
    }
}

// Shows R3.
#[test]
fn an_electrode_that_twitches_renews_no_blind_budget_and_a_proven_contraction_does() {
    for seed in SEEDS {
        let mut bench = Bench::holding(seed);
        bench.pins_mv[FSR] = 0.0;
        bench.run(200);
        let budget = bench.fingertip.config().grip.blind_frames as usize;
        bench.run_in_slips(20_000);
        lifts(&mut bench, MYO_EXTENSOR, 5);
        let spent = bench.by_reflex();
        assert!((20..=budget + 1).contains(&spent), "{spent} frames, {budget} allowed");
        contract(&mut bench, MYO_EXTENSOR, 900.0);
        bench.run_in_slips(20_000);
        assert!(bench.by_reflex() > spent, "renewed");
    }
}

const UNPROVEN: Verdict = Verdict {
    wish: Wish::Open,
    strength_permille: 1_000,
    proven: false,
    heard: false,
    active: true,
    known: true,
    half_known: true,
};

#[derive(Default)]
struct Hand {
    gate: Gate,
    account: Account,
    told: Wish,
}

impl Hand {
    /// Travel in frames of a verdict, per mille of duty times frames; opening is positive.
    fn moves(&mut self, verdict: Verdict, frames: u32, empty: bool) -> i32 {
        let config = Config::default().gate;
        self.gate.take(verdict);
        let frame = |_| {
            self.gate.tick(&config, empty);
            let drive = self.gate.wish(&config, &self.account);
            self.told = self.account.step(&self.gate, drive, true);
            match drive {
                MotorDrive::Open(duty) => i32::from(duty.as_per_mille()),
                MotorDrive::Close(duty) => -i32::from(duty.as_per_mille()),
                MotorDrive::Coast => 0,
            }
        };
        (0..frames).map(frame).sum()
    }
}

// Shows W4.
#[test]
fn time_pays_for_nothing_and_a_refused_wish_is_told_when_it_ends() {
    let (most, rest) = (OPENS_AT_MOST as i32, Verdict { wish: Wish::Rest, active: false, ..UNPROVEN });
    for (wish, all) in [(Wish::Open, most - 299..most + 1), (Wish::Close, -1_000 * CLOSES_AT_MOST as i32..0)]
    {
        let mut hand = Hand::default();
        let first = hand.moves(Verdict { wish, ..UNPROVEN }, 600, false);
        assert!(all.contains(&first), "{first}");
        hand.moves(rest, 8_000_000, false);
        assert_eq!(hand.moves(Verdict { wish, ..UNPROVEN }, 600, false), 0);
        assert_eq!(hand.told, Wish::Rest);
        hand.moves(rest, 1, false);
        assert_eq!(hand.told, wish);
        hand.moves(rest, 1, true);
        assert_eq!(hand.told, Wish::Rest, "an empty hand clears it");
    }
}

#[test]
fn closing_proof_a_rise_of_the_other_electrode_and_an_empty_hand_pay_for_opening() {
    let [closes, rests] = [Wish::Close, Wish::Rest].map(|wish| Verdict { wish, ..UNPROVEN });
    for (pays, empty, frames) in [
        (closes, false, 20),
        (Verdict { proven: true, ..closes }, false, 1),
        (Verdict { proven: true, ..UNPROVEN }, false, 1),
        (rests, true, 1),
    ] {
        let mut hand = Hand::default();
        let first = hand.moves(UNPROVEN, 600, false);
        hand.moves(pays, frames, empty);
        assert_eq!(hand.moves(UNPROVEN, 600, false), first, "{pays:?}");
    }
    let mut hand = Hand::default();
    let first = hand.moves(UNPROVEN, 600, false);
    hand.moves(closes, 4, false);
    assert!((1..first / 2).contains(&hand.moves(UNPROVEN, 600, false)), "as much as was closed");
    // A rise pays once a contraction, and not for what this one has opened already.
    for (soon, mut hand) in [(0, hand), (20, Hand::default())] {
        let all = [(rests, 1), (UNPROVEN, soon), (Verdict { heard: true, ..UNPROVEN }, 900), (UNPROVEN, 600)];
        assert_eq!(all.map(|(says, frames)| hand.moves(says, frames, false)).iter().sum::<i32>(), first);
    }
}
