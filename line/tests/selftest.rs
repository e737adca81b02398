//! The self-test of the wires on the host's board, in virtual time: somebody does what each prompt says, at once.

use std::sync::{Arc, Mutex};

use rayon::prelude::*;
use tenax_frames::link::{Encoder, Inbox};
use tenax_hal_shim::channel::{CHANNELS, COUNT, MOTOR_CURRENT, Role, by_name};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Down, Up};
use tenax_line::selftest::{Selftest, Verdict};
use tenax_scene::plant::{Pins, Plant};
use tenax_scene::{Act, SceneFile, World};
use tenax_sim::board::Recorder;
use tenax_sim::session::Board;

use crate::serving::BENCH;

/// A world at whose bench somebody does what is said; its board streams its readings.
struct Bench {
    world: World,
    acts: Arc<Mutex<Vec<Act>>>,
    encoder: Encoder,
    scans: u32,
}

impl Plant for Bench {
    tenax_scene::put_around!(world);

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.scans += 1;
        self.acts.lock().unwrap().drain(..).for_each(|act| self.world.act(act));
        self.world.scan(drive)
    }

    fn line_bytes(&mut self) -> Vec<u8> {
        let asks = self.scans.is_multiple_of(8 * 8_000) || self.scans == 8_000;
        let stream = Down::Stream { raw: false, senses: true, hold_s: 10 };
        if asks { self.encoder.frame(&stream).1.to_vec() } else { Vec::new() }
    }
}

struct Tester {
    inbox: Inbox,
    test: Selftest,
    acts: Arc<Mutex<Vec<Act>>>,
}

impl Recorder for Tester {
    fn line(&mut self, bytes: &[u8]) {
        for heard in bytes.iter().filter_map(|&byte| self.inbox.push(byte)).flatten() {
            let Up::Senses(senses) = heard.received.message else { continue };
            let known = self.test.said.len();
            self.test.hear(&senses);
            let acts = self.test.said[known..].iter().filter_map(|line| line.parse::<Act>().ok());
            self.acts.lock().unwrap().extend(acts);
        }
    }
}

fn tested(faults: &str, seed: u64) -> Selftest {
    let mut bench = BENCH.replace("= 3600", "= 80");
    // A muscle's wrong wire closes the hand: only then does it matter that the hand is to be empty.
    if faults.contains("myo_") {
        bench = bench.replace("without = [", "without = [\"object\", \"table\", ") + "\n[robot]\n";
    }
    let scene = SceneFile::parse(&(bench + faults), "bench").unwrap_or_else(|error| panic!("{error}"));
    let acts = Arc::<Mutex<Vec<Act>>>::default();
    let test = Selftest::named(&[], false, false, 8).unwrap();
    let mut tester = Tester { inbox: Inbox::default(), test, acts: Arc::clone(&acts) };
    let bench = Bench { world: World::new(&scene, seed), acts, encoder: Encoder::default(), scans: 0 };
    Board::Host.record(bench, &mut tester, &mut |_| {}).unwrap();
    assert!(tester.test.is_over(), "seed {seed}, {faults}: {:#?}", tester.test.said);
    tester.test
}

pub fn fault(channel: &str, kind: &str, with: &str) -> String {
    let with = if with.is_empty() { String::new() } else { format!("with = \"{with}\"\n") };
    format!("\n[[fault]]\nat_s = 0\nchannel = \"{channel}\"\nkind = \"{kind}\"\n{with}reason = \"a test\"\n")
}

/// Faults on one pin, on both switches, and between pin and switch: kind, channel, and the other one or the same.
const FAULTS: [(&str, &str, &str); 15] = [
    ("dead", "pvdf_1", "pvdf_1"),
    ("dead", "strain_3", "strain_3"),
    ("dead", "myo_extensor", "myo_extensor"),
    ("saturated", "fsr_d", "fsr_d"),
    ("saturated", "array_9", "array_9"),
    ("bridged", "pvdf_4", "pvdf_5"),
    ("bridged", "fsr_a", "fsr_b"),
    ("bridged", "array_7", "array_8"),
    ("swapped", "strain_1", "pvdf_2"),
    ("swapped", "pvdf_3", "pvdf_12"),
    ("swapped", "fsr_c", "fsr_d"),
    ("swapped", "opening", "motor_current"),
    ("swapped", "fsr_d", "array_1"),
    ("swapped", "pvdf_9", "myo_flexor"),
    ("swapped", "myo_flexor", "myo_extensor"),
];

/// What is wrong with the verdicts on a bench with this fault, if anything is.
fn wrong(seed: u64, (kind, own, other): (&str, &str, &str)) -> Option<String> {
    let test = tested(&fault(own, kind, if own == other { "" } else { other }), seed);
    let faulty = [own, other].map(|name| by_name(name).unwrap());
    let [own, other] = faulty;
    let is_right = |channel: usize| match (test.verdicts[channel], kind) {
        (Some(Verdict::Dead(_)), "dead") => true,
        (Some(Verdict::Shorted(_)), "saturated") => true,
        (Some(Verdict::Bridged(_)), "bridged") => true,
        // What the reflex does meanwhile may move a wrong wire, too.
        (Some(Verdict::Moved(moved)), "swapped") => faulty.contains(&moved),
        (_, "swapped") => [own, other].iter().any(|n| matches!(test.verdicts[*n], Some(Verdict::Moved(_)))),
        _ => false,
    };
    // What stands on a muscle's wire can drive the motor all the time.
    let drives = kind == "swapped" && faulty.iter().any(|&n| Role::of(n, false) == Role::Muscle);
    let passes =
        |n: usize| matches!(test.verdicts[n], Some(Verdict::Pass(_))) || drives && n == MOTOR_CURRENT;
    let wrong = (0..COUNT).find(|&n| if faulty.contains(&n) { !is_right(n) } else { !passes(n) })?;
    let (name, verdict) = (CHANNELS[wrong].name, test.verdicts[wrong]);
    Some(format!("seed {seed}, {kind} {faulty:?}: {name}: {verdict:?}\n{}", test.said.join("\n")))
}

#[test]
fn each_fault_is_found_and_no_other() {
    let all: Vec<_> = (0..).zip(FAULTS).collect();
    let wrong: Vec<String> = all.into_par_iter().filter_map(|(seed, fault)| wrong(seed, fault)).collect();
    assert!(wrong.is_empty(), "{} wrong\n{}", wrong.len(), wrong.join("\n\n"));
    assert!(tested("", 15).passes(), "a good board has no failure");
}
