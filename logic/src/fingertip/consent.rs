//! Consent to commands of the serial line, and the limits of its drive.

use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{CalibrationRefusal, Line};

use super::Fingertip;
use crate::arming::{STEP_FRAMES, Signs};
use crate::button::Press;

impl Fingertip {
    pub const fn button(&mut self, is_down: bool) {
        self.button_is_down = is_down;
    }

    pub const fn bridge(&mut self, is_off: bool) {
        self.senses.motor.bridge(is_off);
    }

    pub const fn was_reset(&mut self) {
        self.arming.was_reset();
    }

    pub fn line(&self) -> Line {
        self.arming.line(self.config.line_trusted)
    }

    pub(super) fn consent(&mut self) {
        let gate = &self.senses.gate;
        let consent = self.arming.tick(Signs {
            co_contraction: gate.is_co_contracted(&self.config.gate),
            button: self.button_is_down,
            unloaded: self.senses.forces.map(|_| self.senses.unloaded),
        });
        if self.wearer_renews() {
            self.reflex.renew();
        }
        self.press();
        let gate = &self.senses.gate;
        if gate.is_active() || consent.is_some() || self.config.line_trusted {
            self.link.renew();
        }
        let was = core::mem::replace(&mut self.line, self.arming.line(self.config.line_trusted));
        if let Some(by) = consent {
            self.journal.event(EventKind::Armed(by));
        }
        match (was, self.line) {
            (Line::Trusted, Line::Reading | Line::Armed { .. }) => {
                self.journal.event(EventKind::LineTrusted(false));
            }
            (Line::Reading | Line::Armed { .. }, Line::Trusted) => {
                self.journal.event(EventKind::LineTrusted(true));
            }
            (Line::Armed { .. }, Line::Reading) => self.journal.event(EventKind::Disarmed),
            _ => {}
        }
        if core::mem::replace(&mut self.told_no_wearer, self.config.no_wearer) != self.config.no_wearer {
            self.journal.event(EventKind::NoWearer(self.config.no_wearer));
        }
    }

    pub fn light(&self) -> bool {
        self.senses.muscles().light(self.journal.frame())
    }

    #[inline(never)]
    fn press(&mut self) {
        let empty = self.senses.unloaded;
        let gate = &mut self.senses.gate;
        if gate.is_releasing() {
            gate.step_release(STEP_FRAMES);
        }
        let busy = gate.is_releasing() || self.senses.muscles().is_calibrating();
        let gate = &mut self.senses.gate;
        match self.button.tick(self.button_is_down, empty, busy) {
            Some(Press::Release) => gate.release(true),
            Some(Press::Stop) => {
                gate.release(false);
                self.senses.muscles_mut().give_up(CalibrationRefusal::Stopped, &mut self.journal);
            }
            Some(Press::Calibrate) => self.senses.muscles_mut().begin_calibration(self.journal.frame(), true),
            None => {}
        }
    }

    /// Drive of the line within its limits: it closes no harder than the reflex may.
    pub(super) fn link_drive(&self) -> Option<MotorDrive> {
        let drive = self.link.drive()?;
        let grip = self.senses.grip;
        (drive.opens() || self.reflex.link_may_close(&self.config.grip, grip)).then_some(drive)
    }

    /// The drive opens, holds the hand where it is (duty 0), or closes with a motor that is louder than slip.
    pub(super) fn link_silences(&self) -> bool {
        let loud_permille = self.config.hebbian.loud_duty_permille;
        match self.link_drive() {
            Some(MotorDrive::Close(duty)) => !(1..loud_permille).contains(&duty.as_per_mille()),
            drive => drive.is_some(),
        }
    }
}
