//! A plan beside what the hand does by itself.

use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_logic::fingertip::Fingertip;

#[derive(Clone, Copy, Debug, Default)]
pub struct Ahead {
    by: u32,
    opens: bool,
}

impl Ahead {
    pub fn drive(
        &mut self,
        own: MotorDrive,
        fingertip: &Fingertip,
        planned: Option<MotorDrive>,
    ) -> MotorDrive {
        self.opens = match own {
            MotorDrive::Open(_) => true,
            MotorDrive::Close(_) => false,
            MotorDrive::Coast => self.opens && fingertip.wearer_active(),
        };
        let expects_slip = matches!(
            fingertip.behaviour(),
            Some(Behaviour::Turn { .. } | Behaviour::HandOver | Behaviour::Stroke)
        );
        let plan = match planned {
            Some(MotorDrive::Close(duty)) if !self.opens && !expects_slip => u32::from(duty.as_per_mille()),
            _ => 0,
        };
        match own {
            MotorDrive::Open(duty) => {
                let extra = self.by.min(u32::from(Duty::FULL.as_per_mille() - duty.as_per_mille()));
                self.by -= extra;
                MotorDrive::Open(Duty::per_mille(duty.as_per_mille() + extra as u16))
            }
            MotorDrive::Coast if plan == 0 => own,
            MotorDrive::Coast | MotorDrive::Close(_) => {
                let own = if let MotorDrive::Close(duty) = own { u32::from(duty.as_per_mille()) } else { 0 };
                let closes = plan.max(own.saturating_sub(self.by));
                self.by = self.by + closes - own;
                MotorDrive::Close(Duty::per_mille(closes as u16))
            }
        }
    }
}
