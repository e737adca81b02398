//! What a board's line says as ROS 2's messages, and a gripper command as the line's.

use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::channel::{CHANNELS, OPENING, SLOW_HZ, mv_from_sample};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{About, Counters, Down, Senses, Slow};
use tenax_hal_shim::words::{DriveSource, Line};

use crate::message::{
    DiagnosticArray, DiagnosticStatus, Gripper, GripperCommand, Header, JointState, KeyValue, Margin, Slip,
    Tactile, Time,
};

/// The setting that is the ceiling of forces, mN (`tenax_logic::setting::SettingId`).
const FORCE_CEILING: u8 = 4;
/// A drive holds for two slow frames: of a line that is cut the motor is off after so long, ms.
const HOLD_MS: u16 = 25;
/// The longest that one command drives, slow frames: 5 s closing, 2 s opening.
const CLOSES_FOR: u32 = 5 * SLOW_HZ;
const OPENS_FOR: u32 = 2 * SLOW_HZ;
/// How long it opens on after nothing is felt any more, slow frames.
const OPENS_ON_FOR: u32 = SLOW_HZ / 4;
/// Load below which nothing is felt, mN.
const NOTHING_MN: i32 = 300;
/// Load from which something is held, mN, and slow frames for which a report of slip stands.
const HELD_MN: i32 = 600;
const SLIPS_FOR: u32 = SLOW_HZ / 4;
/// Reading of the wholly open hand above that of the closed one, mV.
const OPENING_SPAN_MV: f64 = 2_400.0;
/// How hard it opens, and the least with which a motor moves, per mille.
const OPEN_PERMILLE: u16 = 400;
const CLOSE_PERMILLE_MIN: u16 = 150;

/// How long a loss is warned of, ns: its count stays.
const LOSSY_NS: u64 = 10_000_000_000;

pub fn header(hand: &str, at_ns: u64) -> Header {
    Header { stamp: Time::of_ns(at_ns), frame_id: hand.to_owned() }
}

fn newtons(mn: i32) -> f64 {
    f64::from(mn) / 1e3
}

/// `range_m`: gap of the open hand.
pub fn joint_state(header: Header, slow: &Slow, senses: Option<&Senses>, range_m: f64) -> JointState {
    let position = senses.and_then(opening).map(|part| range_m * part).into_iter().collect();
    let effort = slow.forces.iter().map(|forces| newtons(forces.load_mn)).collect();
    let name = vec![format!("{}_grip", header.frame_id)];
    JointState { header, name, position, effort, ..JointState::default() }
}

/// Opening as a part of the hand's range, 0 to 1. None while its sensor gives no number.
fn opening(senses: &Senses) -> Option<f64> {
    let (mv, channel) = (mv_from_sample(senses.samples[OPENING]), &CHANNELS[OPENING]);
    let part = (f64::from(mv) - f64::from(channel.rest_mv)) / OPENING_SPAN_MV;
    (channel.low_mv..=channel.high_mv).contains(&mv).then_some(part.clamp(0.0, 1.0))
}

/// Gap of fingers that are closed, as a part of the hand's range.
const CLOSED: f64 = 0.02;

/// What an action says of the hand while this grasp goes on.
pub fn gripper(slow: &Slow, senses: Option<&Senses>, range_m: f64, grasp: &Grasp) -> Gripper {
    let (load_mn, part) = (slow.forces.map(|forces| forces.load_mn), senses.and_then(opening));
    let opens = matches!(grasp.aim, Aim::Open { .. });
    let reached_goal = match opens {
        true => load_mn.is_some_and(|mn| mn < NOTHING_MN) && grasp.steps > OPENS_ON_FOR,
        false => part.is_some_and(|part| part < CLOSED),
    };
    Gripper {
        position: part.map_or(f64::NAN, |part| range_m * part),
        effort: load_mn.map_or(f64::NAN, newtons),
        stalled: !opens && load_mn.is_some_and(|mn| mn >= NOTHING_MN),
        reached_goal,
    }
}

/// What became of the object, from slow frame to slow frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Object {
    /// Slow frames since a report of slip, and whether the hand was opened since it held something.
    quiet: u32,
    opened: bool,
    word: Option<&'static str>,
}

impl Object {
    pub fn follow(&mut self, slow: &Slow) -> &'static str {
        let opens = slow
            .ticks
            .iter()
            .any(|tick| matches!(tick.drive, MotorDrive::Open(_)) && tick.source != DriveSource::Reflex);
        let slips = slow.ticks.iter().any(|tick| tick.believed.bits() != 0);
        self.step(slow.forces.map(|forces| forces.load_mn), slips, opens)
    }

    /// `held`, `slipping`, `lost` (the load fell to nothing, and nobody opened the hand) or `none`.
    pub fn step(&mut self, load_mn: Option<i32>, slips: bool, opens: bool) -> &'static str {
        self.quiet = if slips { 0 } else { self.quiet.saturating_add(1) };
        let holds = matches!(self.word, Some("held" | "slipping"));
        let word = match load_mn {
            Some(HELD_MN..) if self.quiet < SLIPS_FOR => "slipping",
            Some(HELD_MN..) => "held",
            Some(..NOTHING_MN) if holds && (self.opened || opens) => "none",
            Some(..NOTHING_MN) if holds => "lost",
            _ => self.word.unwrap_or("none"),
        };
        self.opened = opens || self.opened && holds;
        self.word = Some(word);
        word
    }
}

pub fn slip(header: Header, slow: &Slow) -> Slip {
    let mut message = Slip {
        header,
        mode: slow.mode as u8,
        wearer_active: slow.wearer_active,
        line_may_command: slow.line != Line::Reading,
        ..Slip::default()
    };
    for tick in &slow.ticks {
        message.said |= tick.said.bits();
        message.believed |= tick.believed.bits();
        message.acted |= tick.acted.bits();
        message.vibration_mv = message.vibration_mv.max(mv_from_sample(tick.vibration) as u16);
    }
    message.slipping = message.believed != 0;
    message
}

pub fn margin(header: Header, slow: &Slow) -> Margin {
    let permille = |permille: u16| f64::from(permille) / 1e3;
    let margin = slow.forces.and_then(|forces| forces.margin_mn(slow.s2_permille));
    Margin {
        header,
        valid: margin.is_some(),
        margin: margin.map_or(0.0, newtons),
        ratio: slow.forces.and_then(|forces| forces.ratio_permille).map_or(0.0, permille),
        limit: permille(slow.s2_permille),
        shear_angle: slow.shear_mrad.map_or(0.0, |mrad| f64::from(mrad) / 1e3),
    }
}

pub fn tactile(header: Header, slow: &Slow, senses: Option<&Senses>) -> Tactile {
    let forces = slow.forces.as_ref();
    Tactile {
        header,
        forces_valid: forces.is_some(),
        load: forces.map_or(0.0, |forces| newtons(forces.load_mn)),
        shear_x: forces.map_or(0.0, |forces| newtons(forces.fx_mn)),
        shear_y: forces.map_or(0.0, |forces| newtons(forces.fy_mn)),
        samples: senses.map_or_else(Vec::new, |senses| senses.samples.to_vec()),
        films: senses.map_or_else(Vec::new, |senses| senses.films.to_vec()),
    }
}

pub fn ceiling_mn(about: &About) -> Option<i32> {
    about.settings.iter().find(|setting| setting.id == FORCE_CEILING).map(|setting| setting.value)
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Health {
    pub gone: Option<String>,
    pub command: String,
    /// Where the board is plugged in.
    pub line: String,
    pub about: Option<About>,
    pub counters: Option<Counters>,
    pub missed: u64,
    pub bad_frames: u64,
    /// All that was lost, and when that last grew.
    pub lost: u64,
    pub lost_ns: Option<u64>,
}

impl Health {
    /// Takes the counts of a line.
    pub fn count(&mut self, missed: u64, bad_frames: u64, at_ns: u64) {
        (self.missed, self.bad_frames) = (missed, bad_frames);
        let counters = self.counters.unwrap_or_default();
        let lost = u64::from(counters.frames_lost) + u64::from(counters.ticks_late) + missed + bad_frames;
        if lost > self.lost {
            self.lost_ns = Some(at_ns);
        }
        self.lost = lost;
    }

    pub fn diagnostics(&self, hand: &str, at_ns: u64) -> DiagnosticArray {
        let counters = self.counters.unwrap_or_default();
        let lossy = self.lost_ns.is_some_and(|lost_ns| at_ns.saturating_sub(lost_ns) < LOSSY_NS);
        let (level, message) = match &self.gone {
            Some(why) => (2, why.clone()),
            None if self.counters.is_none() => (3, "nothing heard yet".to_owned()),
            None if lossy => (1, "frames were lost, late or missed within 10 s".to_owned()),
            None => (0, "running".to_owned()),
        };
        let values = [
            ("last command", self.command.clone()),
            ("frames lost", counters.frames_lost.to_string()),
            ("ticks late", counters.ticks_late.to_string()),
            ("messages missed", self.missed.to_string()),
            ("bad frames", self.bad_frames.to_string()),
            ("control per mille", counters.control_permille.to_string()),
            ("line", self.line.clone()),
        ];
        let chip = self.about.as_ref().map_or([0; 3], |about| about.identity.chip);
        let status = DiagnosticStatus {
            level,
            name: format!("{hand}: fingertip"),
            message,
            hardware_id: chip.map(|part| format!("{part:08x}")).concat(),
            values: values.map(|(key, value)| KeyValue { key: key.to_owned(), value }).into(),
        };
        DiagnosticArray { header: header("", at_ns), status: vec![status] }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    Send(Down),
    Wait,
    Done(&'static str),
    /// It ended without what was asked for.
    Over(&'static str),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Aim {
    /// Until it was felt for so many slow frames: the board's own gentle grasp.
    Felt { for_frames: u32 },
    /// Until the load is this, mN, with this duty.
    Load { mn: i32, permille: u16 },
    /// Until nothing was felt for so many slow frames.
    Open { nothing_for: u32 },
}

/// A gripper command that is carried out, a step each slow frame. The board is asked anew each time, for two slow frames:
/// consent, the wearer and the ceiling are decided there, and of a line or a bridge that is gone nothing drives on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grasp {
    aim: Aim,
    steps: u32,
}

impl Grasp {
    pub fn of(command: &GripperCommand, ceiling_mn: Option<i32>) -> Result<Self, &'static str> {
        let GripperCommand { position, max_effort } = *command;
        if !position.is_finite() || !max_effort.is_finite() {
            return Err("refused: a position or an effort that is no number");
        }
        if position < 0.0 || max_effort < 0.0 {
            return Err("refused: a position or an effort below 0");
        }
        let aim = if position > 0.0 {
            Aim::Open { nothing_for: 0 }
        } else if max_effort > 0.0 {
            let ceiling_mn =
                ceiling_mn.filter(|&mn| mn > 0).ok_or("refused: the ceiling is not known yet")?;
            // A number too large is the ceiling.
            let mn = ((max_effort * 1e3) as i32).clamp(1, ceiling_mn);
            // A motor stalls at about the ceiling with its full duty.
            let permille = (i64::from(mn) * 1_000 / i64::from(ceiling_mn)) as u16;
            Aim::Load { mn, permille: permille.saturating_add(100).clamp(CLOSE_PERMILLE_MIN, 1_000) }
        } else {
            Aim::Felt { for_frames: 0 }
        };
        Ok(Self { aim, steps: 0 })
    }

    /// The next step, with the load that the slow frame says, mN.
    pub fn step(&mut self, load_mn: Option<i32>) -> Step {
        let step = self.steps;
        self.steps += 1;
        match &mut self.aim {
            Aim::Felt { .. } if step == 0 => Step::Send(Down::Begin(Behaviour::GentleGrasp)),
            Aim::Felt { for_frames } => {
                *for_frames = if load_mn.is_some_and(|mn| mn >= NOTHING_MN) { *for_frames + 1 } else { 0 };
                match *for_frames > OPENS_ON_FOR {
                    true => Step::Done("the object is felt"),
                    false if step >= CLOSES_FOR => Step::Over("ended: nothing was felt in 5 s"),
                    false => Step::Wait,
                }
            }
            Aim::Load { mn, permille } => match load_mn {
                None => Step::Over("ended: the force sensor gives no number"),
                Some(load) if load >= *mn => Step::Done("the force is reached"),
                _ if step >= CLOSES_FOR => Step::Over("ended: the force was not reached in 5 s"),
                Some(_) => drive(MotorDrive::Close(Duty::per_mille(*permille))),
            },
            Aim::Open { nothing_for } => {
                *nothing_for = if load_mn.is_some_and(|mn| mn < NOTHING_MN) { *nothing_for + 1 } else { 0 };
                if *nothing_for > OPENS_ON_FOR || step >= OPENS_FOR {
                    Step::Done("open")
                } else {
                    drive(MotorDrive::Open(Duty::per_mille(OPEN_PERMILLE)))
                }
            }
        }
    }
}

const fn drive(drive: MotorDrive) -> Step {
    Step::Send(Down::Drive { drive, hold_ms: HOLD_MS })
}
