//! The account of motion without a proof: unproven wishes, and closing while the force or a muscle is unknown.
//! A proven wish, the button or an empty hand clears it. The wearer's closing, and a rise of the other electrode
//! as the wish begins, pay for unproven openings. Time pays for nothing.

use tenax_hal_shim::motor::{Duty, MotorDrive};

use crate::emg::Verdict;
use crate::emg::decide::Wish;
use crate::gate::Gate;

/// Largest net travel of unproven openings, per mille of duty times frames: 0.7 mm with a gripper of 120 mm/s.
pub const OPENS_AT_MOST: u32 = 11_600;
/// Longest unproven closing in all, frames: 92 ms.
pub const CLOSES_AT_MOST: u32 = 184;
/// Frames of refused wishes in all that are reported once the wish ends: 0.5 s, longer than a proof takes.
const REFUSED_FRAMES: u32 = 1_000;

#[derive(Clone, Copy, Debug, Default)]
pub struct Account {
    /// Net travel of unproven openings, per mille of duty times frames.
    pub(crate) opened: u32,
    /// That of before this opening.
    pub(crate) owed: u32,
    /// Frames of unproven closing.
    pub(crate) closed: u32,
    /// Frames of closing by others than the wearer while the force is unknown or an electrode is lost.
    pub blind: u32,
    /// Frames in which an unproven wish was refused, and the last such wish.
    pub(crate) refused: u32,
    pub(crate) refuses: Wish,
    pub(crate) told: Wish,
    pub(crate) heard: bool,
}

impl Account {
    /// A frame's opening at this duty is still within the account.
    pub fn may_open(&self, duty: Duty) -> bool {
        self.opened + u32::from(duty.as_per_mille()) <= OPENS_AT_MOST
    }

    pub const fn may_close(&self) -> bool {
        self.closed < CLOSES_AT_MOST
    }

    /// A frame's wish of the gate, and whether it drove the motor. Gives the wish whose refusal is to be reported.
    pub fn step(&mut self, gate: &Gate, asked: MotorDrive, driven: bool) -> Wish {
        let Verdict { wish, heard, .. } = *gate.verdict();
        if wish != Wish::Open {
            self.owed = self.opened;
        } else if heard && !self.heard {
            // What this wish has opened already stays in the account: the rise may be the fault's own.
            self.opened = self.opened.saturating_sub(self.owed);
        }
        self.heard = heard;
        if gate.is_trusted() || gate.is_releasing() {
            *self = Self { heard, ..Self::default() };
        } else if wish == Wish::Rest {
            self.told = if self.refused >= REFUSED_FRAMES { self.refuses } else { Wish::Rest };
        } else {
            match asked {
                MotorDrive::Coast => (self.refused, self.refuses) = (self.refused.saturating_add(1), wish),
                MotorDrive::Open(duty) if driven => self.opened += u32::from(duty.as_per_mille()),
                MotorDrive::Close(duty) if driven => {
                    self.closed += 1;
                    self.opened = self.opened.saturating_sub(duty.as_per_mille().into());
                }
                _ => {}
            }
        }
        self.told
    }
}
