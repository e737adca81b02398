//! Who drives the motor. The order of the arms is the contract with the wearer.

use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::words::DriveSource;

/// What each source asks for in one tick.
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
    /// What a behaviour asks for: the only one besides the wearer and the line that may open.
    pub behaviour: MotorDrive,
}

/// The drive of this tick, and its source.
#[must_use]
pub const fn arbitrate(wishes: Wishes) -> (MotorDrive, DriveSource) {
    match wishes {
        // The wearer's open command always wins.
        Wishes { wearer: open @ MotorDrive::Open(_), .. } => (open, DriveSource::Wearer),
        // Then the wearer's muscles, even when all they ask for is rest.
        Wishes { wearer: MotorDrive::Coast, wearer_active: true, .. } => {
            (MotorDrive::Coast, DriveSource::Nobody)
        }
        Wishes { wearer: close @ MotorDrive::Close(_), .. } => (close, DriveSource::Wearer),
        // Then a command that moves the hand. It opens nothing that the wearer holds, and one to coast asks for nothing: it
        // does not silence the reflex.
        Wishes { link: Some(drive @ (MotorDrive::Open(_) | MotorDrive::Close(_))), .. } => {
            (drive, DriveSource::Link)
        }
        // Then the reflex, which only ever closes.
        Wishes { reflex: close @ MotorDrive::Close(_), .. } => (close, DriveSource::Reflex),
        // Then a behaviour: what it loosens, the reflex may tighten at any time.
        Wishes { behaviour: drive @ (MotorDrive::Open(_) | MotorDrive::Close(_)), .. } => {
            (drive, DriveSource::Behaviour)
        }
        Wishes { .. } => (MotorDrive::Coast, DriveSource::Nobody),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_hal_shim::motor::Duty;

    // Shows W2.
    #[test]
    fn the_contract_over_every_combination() {
        let drives = [MotorDrive::Coast, MotorDrive::Close(Duty::FULL), MotorDrive::Open(Duty::FULL)];
        let links = [None, Some(drives[0]), Some(drives[1]), Some(drives[2])];
        for wearer in drives {
            for link in links {
                for (reflex, behaviour) in
                    drives.into_iter().flat_map(|reflex| drives.map(|behaviour| (reflex, behaviour)))
                {
                    for wearer_active in [false, true] {
                        check(Wishes { wearer_active, wearer, link, reflex, behaviour });
                    }
                }
            }
        }
    }

    fn check(wishes: Wishes) {
        let Wishes { wearer_active, wearer, link, reflex, behaviour } = wishes;
        let (drive, source) = arbitrate(wishes);
        let wearer_asks = wearer_active || wearer != MotorDrive::Coast;
        let link_opens = link.is_some_and(MotorDrive::opens) && !wearer_asks;
        let free = !wearer_asks && link.is_none_or(|link| link == MotorDrive::Coast);
        let behaves = free && !reflex.closes() && behaviour != MotorDrive::Coast;
        let open_asked = wearer.opens() || link_opens || (behaves && behaviour.opens());
        assert_eq!(drive.opens(), open_asked, "nothing else opens, and nothing stops the wearer");
        assert!(!(wearer_asks && source == DriveSource::Link));
        assert!(link != Some(MotorDrive::Coast) || source != DriveSource::Link);
        assert_eq!(source == DriveSource::Reflex, free && reflex.closes());
        assert_eq!(source == DriveSource::Behaviour, behaves, "the reflex tightens what a behaviour loosens");
        assert!(!(wearer_active && matches!(source, DriveSource::Reflex | DriveSource::Behaviour)));
        assert!(source != DriveSource::Reflex || drive.closes());
        assert_eq!(source == DriveSource::Nobody, drive == MotorDrive::Coast);
    }
}
