//! Commands of the serial line.

use core::ops::RangeInclusive;

use crate::setting::SettingId;
use tenax_hal_shim::behaviour::Ending;
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{DRIVE_HOLD_MAX_MS, Down, Refusal, Setting};
use tenax_hal_shim::words::Line;

use super::Fingertip;
use crate::config::Config;

/// Settings of a transaction that is not complete.
#[derive(Clone, Copy, Debug)]
pub(super) struct Staged {
    of: u16,
    /// Number of the next one.
    next: u8,
    refused: bool,
    /// Settings changed when it began.
    since: u32,
    config: Config,
}

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
            Down::Set(setting) => self.stage(0, 0, 1, setting),
            Down::SetOf { of, n, count, setting } => self.stage(of, n, count, setting),
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
            Down::CalibrateEmg | Down::Zero if self.senses.forces.is_none() => Err(Refusal::SensorLost),
            Down::CalibrateEmg if self.senses.unloaded => {
                self.senses.muscles_mut().begin_calibration(self.journal.frame(), false);
                Ok(())
            }
            Down::CalibrateEmg => Err(Refusal::Loaded),
            Down::Zero => self.senses.zero().then_some(()).ok_or(Refusal::Loaded),
        }
    }

    fn consents_to(&self, command: &Down) -> Result<(), Refusal> {
        // Trusting the line, or declaring that there is no wearer, needs consent by muscles or button, not by power-up.
        let for_ever = matches!(*command, Down::Set(Setting { id, .. }) | Down::SetOf { setting: Setting { id, .. }, .. }
            if [SettingId::LineTrusted.number(), SettingId::NoWearer.number()].contains(&id));
        let consents = match self.line() {
            Line::Reading => false,
            Line::Armed { .. } => !for_ever || self.arming.is_deliberate(),
            Line::Trusted => true,
        };
        if consents { Ok(()) } else { Err(Refusal::NotArmed) }
    }

    #[inline(never)]
    fn stage(&mut self, of: u16, n: u8, count: u8, setting: Setting) -> Result<(), Refusal> {
        let since = self.settings_changed;
        if n == 0 {
            self.staged = Some(Staged { of, next: 0, refused: false, since, config: self.config });
        }
        let expected = |staged: &&mut Staged| (staged.of, staged.next, staged.since) == (of, n, since);
        let staged = self.staged.as_mut().filter(expected).ok_or(Refusal::Incomplete)?;
        staged.next = n.saturating_add(1);
        let id = SettingId::from_number(setting.id).ok_or(Refusal::UnknownSetting);
        let out_of_range = |range: RangeInclusive<i32>| {
            let (min, max) = range.into_inner();
            Refusal::OutOfRange { min, max }
        };
        let set = id.and_then(|id| staged.config.set(id, setting.value).map_err(out_of_range));
        staged.refused |= set.is_err();
        set?;
        if staged.next < count {
            return Ok(());
        }
        let (refused, config) = (staged.refused, staged.config);
        self.staged = None;
        if refused {
            return Err(Refusal::Incomplete);
        }
        self.config = config;
        self.settings_changed = since.wrapping_add(1);
        Ok(())
    }
}
