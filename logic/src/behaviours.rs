//! Behaviours: movements on request of the line (FingerVision 2017, section II). A behaviour asks to tighten
//! or to relax; wearer, line and reflex come before it. Stroke, hand-over and a part of a turn answer slip
//! themselves ([`Running::answers_slip`]).

mod felt;
mod gentle_grasp;
mod hand_over;
mod hold;
mod movement;
pub mod settings;
mod turn;

use tenax_hal_shim::behaviour::{Behaviour, Ending};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::words::{GripMode, Line};

use self::gentle_grasp::GentleGrasp;
use self::hand_over::HandOver;
use self::hold::Hold;
use self::movement::Movement;
use self::turn::Turn;
use crate::grip::Grip;
use tenax_hal_shim::channel::frames;

pub use self::settings::BehaviourConfig;
pub use felt::{Felt, Skin};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wish {
    #[default]
    Rest,
    Tighten(Duty),
    Relax(Duty),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    On(Wish),
    Ends(Ending),
}

const STROKE_FRAMES_MAX: u32 = frames(60_000);
const GRASP_FRAMES_MAX: u32 = frames(20_000);
const HAND_OVER_FRAMES_MAX: u32 = frames(20_000);
const TURN_FRAMES_MAX: u32 = frames(60_000);

#[derive(Clone, Debug)]
pub struct Running {
    what: Behaviour,
    elapsed: u32,
    doing: Doing,
}

#[derive(Clone, Debug)]
enum Doing {
    Stroke,
    GentleGrasp(GentleGrasp),
    Hold(Hold),
    HandOver(HandOver),
    Turn(Turn),
}

impl Running {
    pub fn begin(what: Behaviour, felt: &Felt<'_>) -> Option<Self> {
        let doing = match what {
            Behaviour::Stroke if felt.grip == Grip::Unknown => return None,
            Behaviour::Stroke => Doing::Stroke,
            Behaviour::GentleGrasp => Doing::GentleGrasp(GentleGrasp::begin(felt)?),
            Behaviour::Hold => Doing::Hold(Hold::default()),
            Behaviour::HandOver => Doing::HandOver(HandOver::begin(felt)?),
            Behaviour::Turn { by_ddeg } => Doing::Turn(Turn::begin(felt, by_ddeg)?),
        };
        Some(Self { what, elapsed: 0, doing })
    }

    pub const fn what(&self) -> Behaviour {
        self.what
    }

    /// Slip is expected and answered by the behaviour itself, so the reflex must not.
    pub const fn answers_slip(&self) -> bool {
        match &self.doing {
            Doing::Stroke | Doing::HandOver(_) => true,
            Doing::Turn(turn) => turn.answers_slip(),
            Doing::GentleGrasp(_) | Doing::Hold(_) => false,
        }
    }

    pub fn gives_reflex_back(&mut self) -> bool {
        match &mut self.doing {
            Doing::Turn(turn) => {
                turn.secure(Ending::TooLong);
                true
            }
            _ => false,
        }
    }

    pub fn step(&mut self, config: &BehaviourConfig, felt: &Felt<'_>) -> Course {
        self.elapsed = self.elapsed.saturating_add(1);
        let (course, longest) = match &mut self.doing {
            Doing::Stroke => (Course::On(Wish::Rest), STROKE_FRAMES_MAX),
            Doing::GentleGrasp(grasp) => (grasp.step(config, felt), GRASP_FRAMES_MAX),
            Doing::Hold(hold) => (hold.step(config, felt), u32::MAX),
            Doing::HandOver(hand_over) => (hand_over.step(config, felt), HAND_OVER_FRAMES_MAX),
            Doing::Turn(turn) => (turn.step(config, felt), TURN_FRAMES_MAX),
        };
        match course {
            Course::On(_) if self.elapsed >= longest => Course::Ends(Ending::TooLong),
            course => course,
        }
    }
}

pub const fn may_answer_slip(what: Behaviour) -> bool {
    matches!(what, Behaviour::Stroke | Behaviour::HandOver | Behaviour::Turn { .. })
}

pub const fn may_relax(line: Line, grip: Grip, mode: GripMode) -> bool {
    let commands = matches!(line, Line::Armed { .. } | Line::Trusted);
    let known = !matches!(grip, Grip::Unknown);
    commands && known && matches!(mode, GripMode::Watch | GripMode::Wearer)
}

impl Wish {
    pub const fn drive(self) -> MotorDrive {
        match self {
            Self::Rest => MotorDrive::Coast,
            Self::Tighten(duty) => MotorDrive::Close(duty),
            Self::Relax(duty) => MotorDrive::Open(duty),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relaxing_needs_consent_a_known_force_and_a_reflex_at_rest() {
        let armed = Line::Armed { left_s: 3 };
        let holds = Grip::Holds(2_000);
        for (line, grip, mode, may) in [
            (armed, holds, GripMode::Watch, true),
            (Line::Trusted, Grip::Unloaded, GripMode::Wearer, true),
            (Line::Reading, holds, GripMode::Watch, false),
            (armed, Grip::Unknown, GripMode::Watch, false),
            (armed, holds, GripMode::Slip, false),
            (armed, holds, GripMode::Incipient, false),
            (armed, holds, GripMode::Settle, false),
            (armed, holds, GripMode::Standby, false),
        ] {
            assert_eq!(may_relax(line, grip, mode), may, "{line:?} {grip:?} {mode:?}");
        }
    }
}
