//! In-hand rotation: loosen until the object slips, tighten until it does not, until the angle is there (FingerVision 2017,
//! section II-D).
//!
//! The paper's objects turn too far: gravity is faster than a camera and a gripper. With `turn_lead_frames` the angle is
//! extrapolated to the time at which a closing finger stops the object; and a turn ends where another
//! slip would lead further away than it is.

use tenax_hal_shim::behaviour::Ending;
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::motor::Duty;

use super::{BehaviourConfig, Course, Felt, Movement, Wish};
use crate::grip::Grip;
use crate::latest;
use tenax_hal_shim::channel::frames;

/// Time of tightening, frames, after which an object that still slips is falling: the reflex then answers.
const FALLS_FRAMES: u32 = frames(300);
/// Loosening stops at this part of the first load, 1/3: three times the needed force is a firm grasp, so the object should
/// have slipped before.
const LEAST_PART: i32 = 3;
/// Pictures over which it is seen to turn.
const TURNS_PICTURES: usize = 4;
/// How far it turns in them when it surely does, and when it does if the camera sees it move as well; tenths of a degree. The angle's
/// own error is 3 in that time.
const TURNS_DDEG: [i32; 2] = [10, 3];
/// Pictures in a row that see it move without a turn: it slides. Fewer may be wrong.
const SLIDES_PICTURES: u32 = 6;
/// Longest time without an angle from the camera, frames.
const UNSEEN_FRAMES: u32 = frames(200);
/// Small movements that the grasp is kept away from where it slipped last; up to there it is loosened without waiting.
const MARGIN_MOVEMENTS: i32 = 6;

/// Phase of a turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Small movements that open, each waited for.
    Loosens,
    /// Small movements that close, until nothing slips.
    Tightens,
    /// Closes until the grasp is as firm as at first.
    Secures,
}

/// A turn that goes on.
#[derive(Clone, Debug)]
pub struct Turn {
    target_ddeg: i32,
    first_mn: i32,
    load_mn: i32,
    /// Why it ends once the grasp is as firm as at first.
    ends: Ending,
    /// The sign of the way there.
    sign: i32,
    phase: Phase,
    movement: Movement,
    angle_ddeg: i32,
    /// The angles of the last pictures, the newest first.
    last_ddeg: [i32; TURNS_PICTURES],
    /// Pictures in a row that see it move.
    moving_for: u32,
    /// How fast it turns, tenths of a degree a second.
    rate_ddeg_s: i32,
    /// Frames since the picture before.
    since_view: u32,
    /// Angle at the last loosening, tenths of a degree.
    loosened_at_ddeg: i32,
    /// Change of the angle by the last slip, tenths of a degree.
    stride_ddeg: i32,
    /// How much looser the grasp is than at first, per mille of full duty times frames.
    loosened: i32,
    /// How loose it was when it slipped last.
    slipped_at: Option<i32>,
    tightens_for: u32,
}

impl Turn {
    /// None without a camera that sees the object, or without a grasp.
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

    /// While it slips on purpose: until it is clear that it falls.
    pub const fn answers_slip(&self) -> bool {
        !matches!(self.phase, Phase::Secures) && self.tightens_for < FALLS_FRAMES
    }

    /// Makes the grasp as firm as at first, while the reflex may tighten, and then ends for this reason.
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
                // As loose as it may be, and nothing slipped.
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

    /// Takes a picture in, if there is a new one. Whether it slips: by a detector, by the angle, or by what moves. One picture may be
    /// wrong.
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

    /// Whether it is much firmer than where it slipped last.
    fn is_far(&self, config: &BehaviourConfig) -> bool {
        let margin = MARGIN_MOVEMENTS * i32::from(config.duty_permille) * config.movement_frames as i32;
        self.slipped_at.is_some_and(|slipped_at| self.loosened + margin < slipped_at)
    }

    /// Whether it has turned far enough: now, or by the time at which it can be stopped; or nearer than the next slip would
    /// bring it.
    fn is_there(&self, config: &BehaviourConfig) -> bool {
        let lead = config.turn_lead_frames as i32;
        let left_ddeg = (self.target_ddeg - self.angle_ddeg) * self.sign;
        if lead == 0 {
            return left_ddeg <= 0;
        }
        let foreseen_ddeg = match self.phase {
            // A movement that goes on goes on until the fingers have closed.
            Phase::Tightens if !self.movement.is_over() => {
                self.rate_ddeg_s * self.sign * lead / FRAME_HZ as i32
            }
            // And the next slip brings as much as the last.
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
