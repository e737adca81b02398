//! The self-test of the wires on the host's board, in virtual time: somebody does what each prompt says, at once.
//!
//! `TENAX_SELFTEST=SEED` runs all: every channel dead and shorted, all pairs of the list and 20 drawn ones, 20 good boards.
//! The constants were chosen on seed 0.

use std::sync::{Arc, Mutex};

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use tenax_frames::link::{Encoder, Inbox};
use tenax_hal_shim::channel::{CHANNELS, COUNT, MOTOR_CURRENT, Role, STRAIN, by_name};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Down, Up};
use tenax_line::guide::selftest::{Selftest, Verdict};
use tenax_scene::plant::{Pins, Plant};
use tenax_scene::{Act, SceneFile, World};
use tenax_sim::board::Recorder;
use tenax_sim::session::Board;

use crate::serving::BENCH;

/// Lines of the test, and what is to be done at the bench.
#[derive(Default)]
struct Talk {
    said: Vec<String>,
    acts: Vec<Act>,
}

/// A world at whose bench somebody does what is said; its board streams its readings.
struct Bench {
    world: World,
    talk: Arc<Mutex<Talk>>,
    encoder: Encoder,
    scans: u32,
}

impl Plant for Bench {
    fn within(&self) -> Option<&dyn Plant> {
        Some(&self.world)
    }

    fn within_mut(&mut self) -> Option<&mut dyn Plant> {
        Some(&mut self.world)
    }

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.scans += 1;
        let acts = std::mem::take(&mut self.talk.lock().unwrap().acts);
        acts.into_iter().for_each(|act| self.world.act(act));
        self.world.scan(drive)
    }

    fn line_bytes(&mut self) -> Vec<u8> {
        let asks = self.scans.is_multiple_of(8 * 8_000) || self.scans == 8_000;
        let stream = Down::Stream { raw: false, senses: true, hold_s: 10 };
        if asks { self.encoder.frame(&stream).1.to_vec() } else { Vec::new() }
    }
}

/// Runs the test on the board's readings.
struct Tester {
    inbox: Inbox,
    test: Selftest,
    talk: Arc<Mutex<Talk>>,
}

impl Recorder for Tester {
    fn line(&mut self, bytes: &[u8]) {
        for heard in bytes.iter().filter_map(|&byte| self.inbox.push(byte)).flatten() {
            let Up::Senses(senses) = heard.received.message else { continue };
            let known = self.test.said.len();
            self.test.hear(&senses);
            let said = &self.test.said[known..];
            let mut talk = self.talk.lock().unwrap();
            talk.acts.extend(said.iter().filter_map(|line| line.parse::<Act>().ok()));
            talk.said.extend(said.iter().cloned());
        }
    }
}

/// The bench with these faults, tested; and all lines.
fn tested(faults: &str, seed: u64) -> (Selftest, Vec<String>) {
    let mut bench = BENCH.replace("= 3600", "= 80");
    // A muscle's wrong wire closes the hand: only then does it matter that the hand is to be empty.
    if faults.contains("myo_") {
        bench = bench.replace("without = [", "without = [\"object\", \"table\", ") + "\n[robot]\n";
    }
    let scene = SceneFile::parse(&(bench + faults), "bench").unwrap_or_else(|error| panic!("{error}"));
    let talk = Arc::<Mutex<Talk>>::default();
    let test = Selftest::named(&[], false, false, 8).unwrap();
    let mut tester = Tester { inbox: Inbox::default(), test, talk: Arc::clone(&talk) };
    let world = World::new(&scene, seed);
    let bench = Bench { world, talk: Arc::clone(&talk), encoder: Encoder::default(), scans: 0 };
    Board::Host.record(bench, &mut tester, &mut |_| {}).unwrap();
    let said = std::mem::take(&mut talk.lock().unwrap().said);
    assert!(tester.test.is_over(), "seed {seed}, {faults}: {said:#?}");
    (tester.test, said)
}

/// A fault of a channel in a scene file.
pub fn fault(channel: &str, kind: &str, with: &str) -> String {
    let with = if with.is_empty() { String::new() } else { format!("with = \"{with}\"\n") };
    format!("\n[[fault]]\nat_s = 0\nchannel = \"{channel}\"\nkind = \"{kind}\"\n{with}reason = \"a test\"\n")
}

/// Whether a verdict is the expected one.
type Is = fn(Verdict) -> bool;

/// What is wrong, if the verdicts are not the expected ones, and passes for all other channels.
fn wrong(faults: &str, seed: u64, expected: &[(usize, Is)]) -> Option<String> {
    let (test, said) = tested(faults, seed);
    let is_right = |channel: usize| {
        let verdict = test.verdicts[channel];
        match expected.iter().find(|(own, _)| *own == channel) {
            Some((_, is_it)) => verdict.is_some_and(is_it),
            None => matches!(verdict, Some(Verdict::Pass(_))),
        }
    };
    let wrong = (0..COUNT).filter(|&channel| !is_right(channel));
    let wrong: Vec<_> =
        wrong.map(|channel| format!("{}: {:?}", CHANNELS[channel].name, test.verdicts[channel])).collect();
    (!wrong.is_empty()).then(|| format!("seed {seed}{faults}{wrong:?}\n{}", said.join("\n")))
}

/// The seed of a run of all; None: some of it is run, on seed 0.
fn whole() -> Option<u64> {
    std::env::var("TENAX_SELFTEST").ok().map(|seed| seed.parse().expect("TENAX_SELFTEST is a number"))
}

/// Checks all with their seeds, or without `TENAX_SELFTEST` one in `every`.
fn check<T: Send>(
    all: impl IntoIterator<Item = T>,
    every: usize,
    wrong: impl Fn((u64, T)) -> Option<String> + Sync + Send,
) {
    let first = 1_000 * whole().unwrap_or(0);
    let step = if whole().is_some() { 1 } else { every };
    let some: Vec<_> = (first..).zip(all).step_by(step).collect();
    let wrong: Vec<String> = some.into_par_iter().filter_map(wrong).collect();
    assert!(wrong.is_empty(), "{} wrong\n{}", wrong.len(), wrong.join("\n\n"));
}

#[test]
fn a_good_board_has_no_failure() {
    check(0..20, 20, |(seed, _)| wrong("", seed, &[]));
}

#[test]
fn each_dead_and_each_shorted_channel_is_found_and_no_other() {
    let kinds: [(&str, Is); 2] = [
        ("dead", |own| matches!(own, Verdict::Dead(_))),
        ("saturated", |own| matches!(own, Verdict::Shorted(_))),
    ];
    let all = (0..COUNT).flat_map(|channel| kinds.map(|(kind, is_it)| (channel, kind, is_it)));
    check(all, 28, |(seed, (channel, kind, is_it))| {
        wrong(&fault(CHANNELS[channel].name, kind, ""), seed, &[(channel, is_it)])
    });
}

/// Neighbours, far ones, other kinds; on one pin, on both switches, and between pin and switch.
const PAIRS: &str = "\
    strain_1 pvdf_2, pvdf_1 pvdf_2, pvdf_3 pvdf_12, fsr_a fsr_b, strain_1 strain_2, strain_6 strain_12, strain_12 fsr_a, \
    fsr_c fsr_d, array_1 array_2, myo_flexor myo_extensor, array_5 array_10, array_10 myo_flexor, myo_extensor opening, \
    opening motor_current, pvdf_5 fsr_b, pvdf_7 array_3, fsr_d array_1, strain_4 array_4, pvdf_9 myo_flexor, fsr_a opening";

#[test]
fn each_exchanged_pair_is_found_and_no_other() {
    let mut random = ChaCha8Rng::seed_from_u64(whole().unwrap_or(0));
    let drawn = (0..20).filter_map(|_| {
        let [a, b] = [0; 2].map(|_| random.random_range(0..COUNT));
        (a != b).then(|| (CHANNELS[a].name, CHANNELS[b].name))
    });
    let listed = PAIRS.split(", ").map(|pair| pair.split_once(' ').unwrap());
    let pairs: Vec<_> = listed.chain(drawn).collect();
    check(pairs, 13, |(seed, (a, b))| {
        let [own, other] = [a, b].map(|name| by_name(name).unwrap());
        let (test, said) = tested(&fault(a, "swapped", b), seed);
        // One side is enough: what the reflex does meanwhile may move a wrong wire, too.
        let names = |asked, other| test.verdicts[asked] == Some(Verdict::Moved(other));
        let blames =
            |asked, other| matches!(test.verdicts[asked], Some(Verdict::Moved(moved)) if moved != other);
        let is_named = (names(own, other) || names(other, own)) && !blames(own, other) && !blames(other, own);
        // What stands on a muscle's wire can drive the motor all the time.
        let drives = [own, other].iter().any(|&n| Role::of(n, false) == Role::Muscle);
        let mut others = (0..COUNT).filter(|n| !([own, other].contains(n) || drives && *n == MOTOR_CURRENT));
        let all_pass = others.all(|n| matches!(test.verdicts[n], Some(Verdict::Pass(_))));
        (!is_named || !all_pass).then(|| format!("seed {seed}, {a} and {b}:\n{}", said.join("\n")))
    });
}

#[test]
fn two_wires_that_touch_are_found() {
    let pairs = [("pvdf_4", "pvdf_5"), ("strain_3", "strain_9"), ("fsr_a", "fsr_b"), ("array_7", "array_8")];
    check(pairs, 2, |(seed, (a, b))| {
        let is_it: Is = |own| matches!(own, Verdict::Bridged(_));
        wrong(&fault(a, "bridged", b), seed, &[a, b].map(|name| (by_name(name).unwrap(), is_it)))
    });
}

#[test]
fn a_switch_that_is_dead_and_exchanged_select_lines_are_named_as_such() {
    let all = |kind| (0..16).map(|n| fault(CHANNELS[STRAIN + n].name, kind, "")).collect::<String>();
    let (_, said) = tested(&all("dead"), 1);
    assert!(said.iter().any(|line| line.starts_with("All of switch A fails")), "{said:#?}");
    // The lowest line is inverted.
    let pair = |n: usize| fault(CHANNELS[STRAIN + 2 * n].name, "swapped", CHANNELS[STRAIN + 2 * n + 1].name);
    let (_, said) = tested(&(0..4).map(pair).collect::<String>(), 1);
    let says = |is_it: &dyn Fn(&String) -> bool| assert!(said.iter().any(is_it), "{said:#?}");
    says(&|line| line.starts_with("8 of switch A are exchanged"));
    says(&|line| line.ends_with("strain_2 (switch A, 1): exchange their wires"));
}
