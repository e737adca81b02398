//! The behaviour of the fingertip: how it begins, the drive that it may ask for in a tick, how it ends.

use tenax_hal_shim::behaviour::{Behaviour, CameraView, Ending};
use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, frames};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::schedule::{Job, slot_of};
use tenax_hal_shim::wire::{EventKind, Refusal};
use tenax_hal_shim::words::{GripMode, Line};

use super::Fingertip;
use super::verdicts::Verdicts;
use crate::behaviours::{Course, Felt, Running, Wish, may_answer_slip, may_relax};

/// Age from which a picture is ignored, its age on arrival included: the camera is lost, frozen or delayed.
const VIEW_FRAMES_MAX: u32 = frames(200);

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Eye {
    view: Option<CameraView>,
    age_frames: u32,
    is_new: bool,
}

impl Eye {
    pub fn see(&mut self, view: CameraView) {
        let age_frames = frames(view.age_ms.into());
        *self = Self { view: (age_frames < VIEW_FRAMES_MAX).then_some(view), age_frames, is_new: true };
    }

    fn tick(&mut self) {
        self.is_new = false;
        self.age_frames += 1;
        if self.age_frames >= VIEW_FRAMES_MAX {
            self.view = None;
        }
    }
}

impl Fingertip {
    pub fn behaviour(&self) -> Option<Behaviour> {
        self.behaviour.as_ref().map(Running::what)
    }

    pub(super) fn begin(&mut self, what: Behaviour) -> Result<(), Refusal> {
        if self.senses.gate.is_active() {
            return Err(Refusal::WearerActive);
        }
        if self.link.is_exhausted() && may_answer_slip(what) {
            return Err(Refusal::HeldTooLong);
        }
        let may_begin = self.senses.all_ready(&self.config)
            && matches!(self.mode, GripMode::Watch | GripMode::Settle)
            || self.behaviour.is_some();
        let running = Running::begin(what, &self.felt(None)).filter(|_| may_begin);
        let running = running.ok_or(Refusal::SensorLost)?;
        self.end(Ending::Stopped);
        if what == Behaviour::Stroke {
            self.detectors.s2.begin_stroke();
        }
        self.behaviour = Some(running);
        self.journal.event(EventKind::Behaviour(what, None));
        Ok(())
    }

    pub(super) fn end(&mut self, ending: Ending) {
        let Some(running) = self.behaviour.take() else { return };
        self.journal.event(EventKind::Behaviour(running.what(), Some(ending)));
        if running.what() == Behaviour::Stroke {
            self.measured();
        }
    }

    pub(super) fn behave(&mut self, verdicts: Verdicts) -> MotorDrive {
        if self.behaviour.is_none() && self.eye.view.is_none() {
            return MotorDrive::Coast;
        }
        let wish = self.step_behaviour(verdicts);
        self.eye.tick();
        wish
    }

    #[inline(never)]
    fn step_behaviour(&mut self, verdicts: Verdicts) -> MotorDrive {
        let Some(running) = &mut self.behaviour else { return MotorDrive::Coast };
        let is_silent_too_long = match running.what() {
            Behaviour::Stroke => self.link.ends_stroke(),
            _ => self.link.is_exhausted() && running.answers_slip(),
        };
        let ends = if self.senses.gate.is_active() || self.link.drive().is_some() {
            Ending::TakenOver
        } else if !self.senses.all_ready(&self.config) {
            Ending::SensorLost
        } else if is_silent_too_long && !running.gives_reflex_back() {
            Ending::TooLong
        } else {
            let Some(mut running) = self.behaviour.take() else { return MotorDrive::Coast };
            let felt = self.felt(Some(verdicts));
            let (grip, course) = (felt.grip, running.step(&self.config.behaviour, &felt));
            self.behaviour = Some(running);
            match course {
                Course::On(Wish::Tighten(_)) if !self.reflex.link_may_close(&self.config.grip, grip) => {
                    Ending::Ceiling
                }
                Course::On(wish @ Wish::Relax(_)) => match may_relax(self.line(), grip, self.mode) {
                    true => return wish.drive(),
                    false if self.line() == Line::Reading => Ending::NotArmed,
                    false => return MotorDrive::Coast,
                },
                Course::On(wish) => return wish.drive(),
                Course::Ends(ending) => ending,
            }
        };
        self.end(ends);
        MotorDrive::Coast
    }

    fn felt(&self, verdicts: Option<Verdicts>) -> Felt<'_> {
        let vibration = self.senses.vibration;
        Felt {
            view: self.eye.view.as_ref(),
            view_is_new: self.eye.is_new,
            cycle_is_over: self.journal.frame() % u32::from(FRAMES_PER_SLOW_FRAME)
                == u32::from(slot_of(Job::EndOfCycle)),
            taxels: self.senses.taxels(),
            grip: self.senses.grip,
            slips: verdicts.is_some_and(|verdicts| !verdicts.slip.is_empty()),
            stirs: !vibration.impact && vibration.level >= self.config.vibration.s1 / 2,
        }
    }
}
