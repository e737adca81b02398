//! Commands of the serial line.

use core::ops::RangeInclusive;

use crate::setting::SettingId;
use tenax_hal_shim::behaviour::Ending;
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{DRIVE_HOLD_MAX_MS, Down, Refusal, Setting};
use tenax_hal_shim::words::Line;

use super::Fingertip;
use crate::grip::Grip;

impl Fingertip {
    /// The reason why the command was not carried out; nothing has changed then.
    pub fn command(&mut self, command: &Down) -> Result<(), Refusal> {
        if !command.reads() {
            self.consents_to(command)?;
        }
        match *command {
            Down::Ping
            | Down::Samples
            | Down::Network
            | Down::Get(_)
            | Down::Settings(_)
            | Down::Hello
            | Down::Open { .. }
            | Down::About
            | Down::Stream { .. }
            | Down::Last(_) => Ok(()),
            Down::Drive { hold_ms, .. } if hold_ms > DRIVE_HOLD_MAX_MS => {
                Err(Refusal::OutOfRange { min: 0, max: DRIVE_HOLD_MAX_MS.into() })
            }
            Down::Drive { drive: MotorDrive::Close(_) | MotorDrive::Open(_), .. }
                if self.senses.gate.is_active() =>
            {
                Err(Refusal::WearerActive)
            }
            Down::Drive { drive: MotorDrive::Close(_) | MotorDrive::Open(_), .. }
                if self.link.is_exhausted() =>
            {
                Err(Refusal::HeldTooLong)
            }
            Down::Drive { drive, hold_ms } => {
                self.link.ask(drive, u32::from(hold_ms) * FRAME_HZ / 1_000);
                Ok(())
            }
            Down::Set(Setting { id, value }) => {
                let id = SettingId::from_number(id).ok_or(Refusal::UnknownSetting)?;
                self.set(id, value)
            }
            Down::Begin(what) => self.begin(what),
            Down::End => {
                self.end(Ending::Stopped);
                Ok(())
            }
            Down::View(view) => {
                self.eye.see(view);
                Ok(())
            }
            Down::Teach { codes, age_ms } => {
                self.detectors.hebbian.teach(&self.config.hebbian, codes, age_ms);
                Ok(())
            }
            Down::Forget => {
                self.detectors.hebbian.forget();
                // Saved, or the forgotten weights would come back with the power.
                self.save_asked = true;
                Ok(())
            }
            Down::Save => {
                self.save_asked = true;
                Ok(())
            }
            // The wearer's contractions move nothing meanwhile: they could not open a loaded hand.
            Down::CalibrateEmg => match self.senses.grip {
                Grip::Holds(_) => Err(Refusal::Loaded),
                Grip::Unknown => Err(Refusal::SensorLost),
                Grip::Unloaded => {
                    self.senses.muscles_mut().begin_calibration(self.journal.frame());
                    Ok(())
                }
            },
            Down::Zero if self.senses.forces.is_none() => Err(Refusal::SensorLost),
            Down::Zero => {
                if self.senses.zero() {
                    Ok(())
                } else {
                    Err(Refusal::Loaded)
                }
            }
        }
    }

    fn consents_to(&self, command: &Down) -> Result<(), Refusal> {
        // Trusting the line, or declaring that there is no wearer, needs consent by muscles or button, not by power-up.
        let for_ever = matches!(*command, Down::Set(Setting { id, .. })
            if [SettingId::LineTrusted.number(), SettingId::NoWearer.number()].contains(&id));
        let consents = match self.line() {
            Line::Reading => false,
            Line::Armed { .. } => !for_ever || self.arming.is_deliberate(),
            Line::Trusted => true,
        };
        if consents { Ok(()) } else { Err(Refusal::NotArmed) }
    }

    pub(super) fn set(&mut self, id: SettingId, value: i32) -> Result<(), Refusal> {
        let out_of_range = |range: RangeInclusive<i32>| {
            let (min, max) = range.into_inner();
            Refusal::OutOfRange { min, max }
        };
        self.config.set(id, value).map_err(out_of_range)?;
        self.settings_changed = self.settings_changed.wrapping_add(1);
        Ok(())
    }
}
