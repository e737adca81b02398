//! In-hand rotation: loosens until the object slips, tightens until it does not, until the angle is there
//! (FingerVision 2017, section II-D), extrapolated by `turn_lead_frames`.

use tenax_hal_shim::behaviour::Ending;
use tenax_hal_shim::channel::{FRAME_HZ, frames};
use tenax_hal_shim::motor::Duty;

use super::{BehaviourConfig, Course, Felt, Movement, Wish};
use crate::grip::Grip;
use crate::latest;

/// Time of tightening after which an object that still slips is falling: the reflex then answers.
const FALLS_FRAMES: u32 = frames(300);
/// Loosening stops at 1/3 of the first load, where a firm grasp should have slipped.
const LEAST_PART: i32 = 3;
const TURNS_PICTURES: usize = 4;
/// Turn over these pictures, tenths of a degree; the second value if the camera sees motion as well.
const TURNS_DDEG: [i32; 2] = [10, 3];
const SLIDES_PICTURES: u32 = 6;
const UNSEEN_FRAMES: u32 = frames(200);
const MARGIN_MOVEMENTS: i32 = 6;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Loosens,
    Tightens,
    Secures,
}

#[derive(Clone, Debug)]
pub struct Turn {
    target_ddeg: i32,
    first_mn: i32,
    load_mn: i32,
    ends: Ending,
    sign: i32,
    phase: Phase,
    movement: Movement,
    angle_ddeg: i32,
    last_ddeg: [i32; TURNS_PICTURES],
    moving_for: u32,
    rate_ddeg_s: i32,
    since_view: u32,
    loosened_at_ddeg: i32,
    stride_ddeg: i32,
    loosened: i32,
    slipped_at: Option<i32>,
    tightens_for: u32,
}

impl Turn {
    pub fn begin(felt: &Felt<'_>, by_ddeg: i16) -> Option<Self> {
        let angle_ddeg = i32::from(felt.view?.angle_ddeg?);
        let Grip::Holds(load_mn) = felt.grip else { return None };
        Some(Self {
            target_ddeg: angle_ddeg + i32::from(by_ddeg),
            first_mn: load_mn,
            load_mn,
            ends: Ending::Done,
            sign: i32::from(by_ddeg).signum(),
            phase: Phase::Loosens,
            movement: Movement::default(),
            angle_ddeg,
            last_ddeg: [angle_ddeg; TURNS_PICTURES],
            moving_for: 0,
            rate_ddeg_s: 0,
            since_view: 0,
            loosened_at_ddeg: angle_ddeg,
            stride_ddeg: 0,
            loosened: 0,
            slipped_at: None,
            tightens_for: 0,
        })
    }

    pub const fn answers_slip(&self) -> bool {
        !matches!(self.phase, Phase::Secures) && self.tightens_for < FALLS_FRAMES
    }

    pub fn secure(&mut self, ends: Ending) {
        self.ends = ends;
        self.enter(Phase::Secures);
    }

    pub fn step(&mut self, config: &BehaviourConfig, felt: &Felt<'_>) -> Course {
        let slips = match self.look(config, felt) {
            Ok(slips) => slips,
            Err(ending) => return Course::Ends(ending),
        };
        match self.phase {
            Phase::Loosens if slips || self.is_there(config) => {
                self.slipped_at = Some(self.loosened);
                self.enter(Phase::Tightens);
            }
            Phase::Loosens if self.load_mn.saturating_mul(LEAST_PART) < self.first_mn => {
                self.secure(Ending::NoSlip);
            }
            Phase::Loosens => {
                if self.movement.is_over() || (self.is_far(config) && !self.movement.drives()) {
                    self.movement = Movement::relax(config);
                }
            }
            Phase::Tightens => {
                self.tightens_for = self.tightens_for.saturating_add(1);
                if slips && !self.movement.drives() {
                    self.movement = Movement::lasting(config, tighten(config), config.movement_frames);
                } else if self.movement.is_over() {
                    self.stride_ddeg = (self.angle_ddeg - self.loosened_at_ddeg) * self.sign;
                    let next = if self.is_there(config) { Phase::Secures } else { Phase::Loosens };
                    self.enter(next);
                }
            }
            Phase::Secures => {
                if self.loosened <= 0 {
                    return Course::Ends(self.ends);
                }
                self.movement = Movement::lasting(config, tighten(config), 1);
            }
        }
        let wish = self.movement.step();
        self.loosened += match wish {
            Wish::Relax(duty) => i32::from(duty.as_per_mille()),
            Wish::Tighten(duty) => -i32::from(duty.as_per_mille()),
            Wish::Rest => 0,
        };
        Course::On(wish)
    }

    fn look(&mut self, config: &BehaviourConfig, felt: &Felt<'_>) -> Result<bool, Ending> {
        self.since_view = self.since_view.saturating_add(1);
        let view = felt.view.filter(|_| self.since_view < UNSEEN_FRAMES).ok_or(Ending::SensorLost)?;
        let Grip::Holds(load_mn) = felt.grip else { return Err(Ending::Dropped) };
        self.load_mn = load_mn;
        let moves = felt.is_moving(config.moving_e4, true);
        if felt.view_is_new {
            self.moving_for = if moves { self.moving_for.saturating_add(1) } else { 0 };
            if let Some(angle_ddeg) = view.angle_ddeg.map(i32::from) {
                let turned_ddeg = angle_ddeg - self.angle_ddeg;
                self.rate_ddeg_s = turned_ddeg * FRAME_HZ as i32 / self.since_view.clamp(1, FRAME_HZ) as i32;
                self.angle_ddeg = angle_ddeg;
                self.since_view = 0;
                latest::push(&mut self.last_ddeg, angle_ddeg);
            }
        }
        let turned_ddeg = (self.last_ddeg[0] - self.last_ddeg[TURNS_PICTURES - 1]).abs();
        let [surely, perhaps] = TURNS_DDEG.map(|least_ddeg| turned_ddeg >= least_ddeg);
        let seen = surely || moves && (perhaps || self.moving_for >= SLIDES_PICTURES);
        Ok(seen || felt.slips || felt.stirs)
    }

    fn is_far(&self, config: &BehaviourConfig) -> bool {
        let margin = MARGIN_MOVEMENTS * i32::from(config.duty_permille) * config.movement_frames as i32;
        self.slipped_at.is_some_and(|slipped_at| self.loosened + margin < slipped_at)
    }

    /// Turned far enough: now, once it can be stopped, or nearer than the next slip would bring it.
    fn is_there(&self, config: &BehaviourConfig) -> bool {
        let lead = config.turn_lead_frames as i32;
        let left_ddeg = (self.target_ddeg - self.angle_ddeg) * self.sign;
        if lead == 0 {
            return left_ddeg <= 0;
        }
        let foreseen_ddeg = match self.phase {
            // A movement under way lasts until the fingers have closed.
            Phase::Tightens if !self.movement.is_over() => {
                self.rate_ddeg_s * self.sign * lead / FRAME_HZ as i32
            }
            // The next slip turns as far as the last.
            _ => self.stride_ddeg / 2,
        };
        left_ddeg <= foreseen_ddeg.max(0)
    }

    fn enter(&mut self, phase: Phase) {
        self.phase = phase;
        self.movement = Movement::default();
        self.tightens_for = 0;
        if phase == Phase::Loosens {
            self.loosened_at_ddeg = self.angle_ddeg;
        }
        if phase == Phase::Tightens {
            self.tightens_for = 1;
        }
    }
}

fn tighten(config: &BehaviourConfig) -> Wish {
    Wish::Tighten(Duty::per_mille(config.duty_permille.saturating_mul(2)))
}
