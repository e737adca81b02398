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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fingers_are_where_the_further_of_the_two_has_closed_them() {
        let (mut ahead, fingertip) = (Ahead::default(), Fingertip::trusting());
        let close = |duty| MotorDrive::Close(Duty::per_mille(duty));
        let mut drive = |own, plan: Option<u16>| ahead.drive(own, &fingertip, plan.map(close));
        assert_eq!(drive(MotorDrive::Coast, Some(300)), close(300));
        // What the hand closes itself was closed already, ...
        assert_eq!(drive(close(200), None), close(0));
        assert_eq!(drive(close(200), None), close(100));
        assert_eq!(drive(close(200), None), close(200));
        // ... and opening makes up for what the plan closed; it never closes against it.
        assert_eq!(drive(MotorDrive::Coast, Some(300)), close(300));
        assert_eq!(
            drive(MotorDrive::Open(Duty::per_mille(500)), Some(900)),
            MotorDrive::Open(Duty::per_mille(800))
        );
        assert_eq!(
            drive(MotorDrive::Open(Duty::per_mille(500)), None),
            MotorDrive::Open(Duty::per_mille(500))
        );
    }
}
