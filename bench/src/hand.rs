//! Several fingertips on one object, each the host's own build of the logic, with a palm on one bus.

mod board;
pub mod bus;
#[cfg(feature = "emulator")]
pub mod emulated;
pub mod report;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::words::GripMode;
use tenax_logic::mode;
use tenax_palm::bus::{Chip, FRAME_MAX};
use tenax_palm::finger::Finger as End;
use tenax_palm::palm::{Palm, Report};
use tenax_palm::places::Place;
use tenax_palm::share::{self, Contact};
use tenax_scene::SceneFile;
use tenax_scene::fingers::Fingers;
use tenax_serial::link::{Counts, Inbox};

use self::board::Board;
use self::bus::{SLOT_HZ, Wires};
use crate::board::kept;

/// The first slot of the bus in a scan.
const fn slot_of(scan: u64) -> u64 {
    scan * SLOT_HZ as u64 / SCAN_HZ as u64
}
/// An answer begins so long after its question, us (assumed: 7700 instructions at 1.5 cycles each, where the image has come to take 5500);
/// and so much later by chance, where a control tick comes between (assumed).
const TURN_US: f64 = 115.0;
const TURN_JITTER_US: f64 = 45.0;
/// A finger's interrupt is so late at most, us (assumed: behind control's).
const LATE_US: f64 = 30.0;
/// Crystals are off by so many ppm at most, either way.
const CRYSTAL_PPM: f64 = 100.0;
/// Slip that is told later than this is not told, s.
const TOLD_S: f64 = 0.1;
/// A slip of a finger is one if it did not slide so long before, s.
const APART_S: f64 = 0.3;

/// What breaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// This finger's power.
    Finger(usize),
    /// The palm's.
    Palm,
    /// The wires.
    Bus,
    /// This finger's driver stays on.
    Driver(usize),
    /// This finger's end of the bus, which starts anew.
    Restart(usize),
    /// The second finger takes the first one's address and numbers.
    Twin(usize, usize),
}

#[derive(Clone, Debug)]
pub struct Options {
    pub seed: u64,
    pub palm: bool,
    /// Whether the fingers' reflexes act at all: the control.
    pub reflex: bool,
    /// What breaks, and when, s.
    pub cut: Option<(f64, Part)>,
    /// When it ends, s; the scene's end if that comes first.
    pub until_s: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { seed: 1, palm: true, reflex: true, cut: None, until_s: f64::INFINITY }
    }
}

/// Somebody else on the bus: its bytes, whenever it has finished the last.
pub type Intruder<'a> = &'a mut dyn FnMut(f64) -> Vec<u8>;

#[derive(Debug, Default)]
pub struct Outcome {
    pub dropped: bool,
    pub slid_mm: f64,
    /// Somebody else than the wearer opened.
    pub opened: bool,
    /// Somebody else than wearer and reflex drove a motor, or a motor without power was driven.
    pub driven: bool,
    /// Pulses of all fingers that the palm wished for.
    pub wished: u32,
    /// Pulses of all fingers.
    pub pulses: u32,
    /// Sums of forces, and the least that would do by what is true, and by what the fingers know, N; 80 times a second.
    pub sums: Vec<Sum>,
    /// From a finger's slip to its neighbours' evidence, s; and slips of which nobody was told.
    pub evidence_s: Vec<f64>,
    pub untold: u32,
    /// The same from where that finger's own detectors said so.
    pub said_s: Vec<f64>,
    /// How far a finger's clock was off, us.
    pub clock_us: f64,
    /// The longest cycle of polls, us, and how many there were.
    pub cycle_us: u32,
    pub cycles: u32,
    /// What came up each finger's line.
    pub lines: Vec<Counts>,
    /// Messages that found no room on a finger.
    pub line_dropped: u32,
    /// When what was reported, s.
    pub reports: Vec<(f64, Report)>,
    pub end_n: Vec<f64>,
}

/// Forces at one instant, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sum {
    pub pressed_n: f64,
    /// The least by the true friction, load and shear.
    pub least_n: Option<f64>,
    /// The least by each finger's lower bound of friction.
    pub known_n: Option<f64>,
}

/// A slip that is waited for.
#[derive(Clone, Copy, Debug, Default)]
struct Slip {
    began_s: Option<f64>,
    said_s: Option<f64>,
    slid_s: f64,
}

/// Runs a hand to its end.
///
/// # Panics
/// If the scene is none of several fingertips.
pub fn run(scene: &SceneFile, options: &Options, mut intruder: Option<Intruder<'_>>) -> Outcome {
    let mut world = Fingers::new(scene, options.seed).expect("a scene of several fingertips");
    let count = world.fingers().len();
    let mut random = ChaCha8Rng::seed_from_u64(options.seed ^ 0x9A11);
    let wearer =
        world.calibrated().map(|calibrated| kept::model_of(&calibrated).expect("the scenes' wearer is one"));
    let mut boards: Vec<Board> = (0..count)
        .map(|n| {
            let ppm = random.random_range(-CRYSTAL_PPM..=CRYSTAL_PPM);
            let begins_us = random.random_range(0.0..5e6);
            Board::new(kept::device(false, wearer.as_ref()), chip(options.seed, n), ppm, begins_us)
        })
        .collect();
    let places: Vec<Place> = world
        .fingers()
        .iter()
        .enumerate()
        .map(|(n, finger)| Place {
            chip: chip(options.seed, n),
            normal: finger.pushes().map(|part| (part * 1e3).round() as i16),
            ceiling_mn: boards[n].device.fingertip().config().grip.ceiling_mn,
        })
        .collect();
    if !options.reflex {
        boards.iter_mut().for_each(|board| board.device.fingertip_mut().act_on(DetectorSet::NONE));
    }
    let mut palm = options.palm.then(|| Palm::new(&places, 0));
    let mut wires = Wires::new(count + 2);
    let (mut outcome, mut out) = (Outcome::default(), [0; FRAME_MAX]);
    let mut lines: Vec<Inbox> = (0..count).map(|_| Inbox::default()).collect();
    let mut slips = vec![Slip { slid_s: -APART_S, ..Slip::default() }; count];
    let mut modes = vec![GripMode::Standby; count];
    let mut cut = options.cut;
    let scans = (scene.duration_s().min(options.until_s) * f64::from(SCAN_HZ)) as u64;
    for scan in 0..scans {
        let t_s = scan as f64 / f64::from(SCAN_HZ);
        if let Some((_, part)) = cut.filter(|(at_s, _)| t_s >= *at_s) {
            cut = None;
            match part {
                Part::Finger(n) => boards[n].cut(),
                Part::Palm => palm = None,
                Part::Bus => wires.is_cut = true,
                Part::Driver(n) => wires.stick(n),
                Part::Restart(n) => boards[n].end = End::new(chip(options.seed, n)),
                Part::Twin(of, n) => boards[n].end = boards[of].end.twin(chip(options.seed, n)),
            }
        }
        let drives: Vec<MotorDrive> = boards.iter().map(|board| board.drive).collect();
        world.scan(&drives);
        for (board, finger) in boards.iter_mut().zip(world.fingers()) {
            board.scan(finger.pins().codes());
        }
        watch(&mut outcome, &mut slips, &boards, &world, t_s);
        for slot in slot_of(scan)..slot_of(scan + 1) {
            let true_us = slot as f64 * 1e6 / f64::from(SLOT_HZ);
            for (n, board) in boards.iter_mut().enumerate() {
                if board.run(true_us) {
                    ticked(&mut outcome, board, &mut modes[n]);
                }
            }
            if let Some(palm) = palm.as_mut().filter(|_| !wires.is_sending(count)) {
                let length = palm.step(true_us as u32, &mut out);
                wires.send(count, &out[..length], slot);
                while let Some(report) = palm.next_report() {
                    outcome.reports.push((t_s, report));
                }
            }
            if let Some(intruder) = intruder.as_mut().filter(|_| !wires.is_sending(count + 1)) {
                let bytes = intruder(t_s);
                wires.send(count + 1, &bytes, slot);
            }
            let Some((byte, by)) = wires.step(slot) else { continue };
            for (n, board) in boards.iter_mut().enumerate().filter(|(n, _)| by != Some(*n)) {
                let late_us = if byte == 0 { random.random_range(0.0..=LATE_US) } else { 0.0 };
                if let Some(answer) = board.hear(byte, true_us, late_us, &mut out) {
                    let turn_us =
                        TURN_US + random.random_range(0.0..=TURN_JITTER_US) + f64::from(answer.after_us);
                    let begins = slot + (turn_us * f64::from(SLOT_HZ) / 1e6) as u64;
                    wires.send(n, &out[..answer.length], begins);
                }
            }
            if let Some(palm) = palm.as_mut().filter(|_| by != Some(count))
                && let Some(finger) = palm.hear(byte, true_us as u32)
            {
                let bytes = palm.state(finger).map(|state| state.line.clone()).unwrap_or_default();
                bytes.iter().for_each(|&byte| _ = lines[finger].push(byte));
            }
        }
        if scan % (u64::from(SCAN_HZ) / 80) == 0 && t_s > 4.6 {
            outcome.sums.push(sum(&world, &boards));
        }
    }
    (outcome.dropped, outcome.slid_mm) = (world.is_dropped(), world.slid_mm());
    (outcome.cycle_us, outcome.cycles) = palm.as_ref().map_or((0, 0), Palm::cycles);
    outcome.wished = boards.iter().map(|board| board.wished).sum();
    outcome.lines = lines.iter().map(Inbox::counts).collect();
    outcome.line_dropped = boards.iter().map(|board| board.end.dropped()).sum();
    outcome.end_n = world.fingers().iter().map(|finger| finger.touch().normal_n).collect();
    outcome
}

fn chip(seed: u64, finger: usize) -> Chip {
    [seed as u32, 7, finger as u32]
}

fn ticked(outcome: &mut Outcome, board: &Board, before: &mut GripMode) {
    let fingertip = board.device.fingertip();
    let now = fingertip.mode();
    outcome.pulses += u32::from(mode::closes(now) && !mode::closes(*before));
    *before = now;
    outcome.opened |= board.drive.opens() && !fingertip.wearer_active();
    outcome.driven |= board.drive.closes() && !fingertip.wearer_active() && !mode::closes(now);
    outcome.driven |= !board.is_on && board.drive != MotorDrive::Coast;
    if let Some(error_us) = board.clock_error_us().filter(|_| board.end.address() != 0) {
        outcome.clock_us = outcome.clock_us.max(error_us.abs());
    }
}

/// Follows each finger's slip until its neighbours know of it.
fn watch(outcome: &mut Outcome, slips: &mut [Slip], boards: &[Board], world: &Fingers, t_s: f64) {
    for (n, (slip, finger)) in slips.iter_mut().zip(world.fingers()).enumerate() {
        let touch = finger.touch();
        let slides = touch.normal_n > 0.2 && !touch.sticks && !world.is_dropped();
        if slides && t_s - slip.slid_s > APART_S && t_s > 4.6 {
            (slip.began_s, slip.said_s) = (Some(t_s), None);
        }
        if slides {
            slip.slid_s = t_s;
        }
        let Some(began_s) = slip.began_s else { continue };
        let own = boards[n].end.address();
        if slip.said_s.is_none() && !boards[n].end.slip().is_empty() {
            slip.said_s = Some(t_s);
        }
        let told = |board: &Board| board.end.neighbours() >> (own.max(1) - 1) & 1 == 1;
        let all = own != 0
            && boards.iter().enumerate().filter(|(other, _)| *other != n).all(|(_, board)| told(board));
        if all {
            outcome.evidence_s.push(t_s - began_s);
            outcome.said_s.extend(slip.said_s.map(|said_s| t_s - said_s));
            slip.began_s = None;
        } else if t_s - began_s > TOLD_S {
            outcome.untold += 1;
            slip.began_s = None;
        }
    }
}

/// The forces now, and the least that would do.
fn sum(world: &Fingers, boards: &[Board]) -> Sum {
    let fingers = world.fingers();
    let milli = |n: f64| (n * 1e3).round() as i32;
    let normal = |pushes: [f64; 2]| pushes.map(|part| (part * 1e3).round() as i16);
    // What the fingers push with together is what pulls it aside.
    let load = world.aside_n().map(|n| -(n * 1e6) as i64);
    let least = |friction: &dyn Fn(usize, f64) -> Option<f64>| {
        let contacts: Option<Vec<Contact>> = fingers
            .iter()
            .enumerate()
            .map(|(n, finger)| {
                let least_mn = milli(finger.touch().shear_n.abs() / friction(n, finger.friction().mu_s)?);
                Some(Contact { normal: normal(finger.pushes()), least_mn, most_mn: 100_000 })
            })
            .collect();
        let forces = share::share(&contacts?, load)?;
        Some(forces.iter().map(|&mn| f64::from(mn) / 1e3).sum())
    };
    let known = |n: usize, _: f64| Some(f64::from(boards.get(n)?.end.felt()?.friction_permille) / 1e3);
    Sum {
        pressed_n: fingers.iter().map(|finger| finger.touch().normal_n).sum(),
        least_n: least(&|_, mu_s| Some(mu_s)),
        known_n: least(&known),
    }
}
