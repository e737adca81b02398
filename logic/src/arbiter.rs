//! Who drives the motor. The order of the arms is the contract with the wearer.

use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::words::DriveSource;

/// What everybody wants in one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wishes {
    /// A myosensor is active, its hold time included.
    pub wearer_active: bool,
    /// What the muscles ask for.
    pub wearer: MotorDrive,
    /// A drive command that still holds.
    pub link: Option<MotorDrive>,
    /// What the reflex asks for.
    pub reflex: MotorDrive,
}

/// Who gets it.
#[must_use]
pub const fn arbitrate(wishes: Wishes) -> (MotorDrive, DriveSource) {
    match wishes {
        // An open command always wins, whoever gives it.
        Wishes { wearer: open @ MotorDrive::Open(_), .. } => (open, DriveSource::Wearer),
        Wishes { link: Some(open @ MotorDrive::Open(_)), .. } => (open, DriveSource::Link),
        // Then the wearer's muscles, even when all they ask for is rest.
        Wishes { wearer: MotorDrive::Coast, wearer_active: true, .. } => {
            (MotorDrive::Coast, DriveSource::Nobody)
        }
        Wishes { wearer: close @ MotorDrive::Close(_), .. } => (close, DriveSource::Wearer),
        // Then a command, even one to stop.
        Wishes { link: Some(MotorDrive::Coast), .. } => (MotorDrive::Coast, DriveSource::Nobody),
        Wishes { link: Some(drive), .. } => (drive, DriveSource::Link),
        // Then the reflex, which only ever closes.
        Wishes { reflex: close @ MotorDrive::Close(_), .. } => (close, DriveSource::Reflex),
        Wishes { .. } => (MotorDrive::Coast, DriveSource::Nobody),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_hal_shim::motor::Duty;

    #[test]
    fn the_contract_over_every_combination() {
        let drives = [MotorDrive::Coast, MotorDrive::Close(Duty::FULL), MotorDrive::Open(Duty::FULL)];
        let links = [None, Some(drives[0]), Some(drives[1]), Some(drives[2])];
        for wearer in drives {
            for link in links {
                for reflex in drives {
                    for wearer_active in [false, true] {
                        let (drive, source) = arbitrate(Wishes { wearer_active, wearer, link, reflex });
                        let open_asked = wearer.opens() || link.is_some_and(MotorDrive::opens);
                        assert_eq!(drive.opens(), open_asked, "nothing else opens, and nothing stops it");
                        assert!(!(wearer_active && source == DriveSource::Reflex));
                        assert!(source != DriveSource::Reflex || drive.closes());
                        assert_eq!(source == DriveSource::Nobody, drive == MotorDrive::Coast);
                    }
                }
            }
        }
    }
}
