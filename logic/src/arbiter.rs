//! Who drives the motor. The order of the arms is the contract with the wearer.

use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::words::DriveSource;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wishes {
    pub wearer_active: bool,
    pub wearer: MotorDrive,
    pub link: Option<MotorDrive>,
    pub reflex: MotorDrive,
    pub behaviour: MotorDrive,
}

pub const fn arbitrate(wishes: Wishes) -> (MotorDrive, DriveSource) {
    match wishes {
        // The wearer's open command always wins.
        Wishes { wearer: open @ MotorDrive::Open(_), .. } => (open, DriveSource::Wearer),
        // Then the wearer's muscles, even when all they ask for is rest.
        Wishes { wearer: MotorDrive::Coast, wearer_active: true, .. } => {
            (MotorDrive::Coast, DriveSource::Nobody)
        }
        Wishes { wearer: close @ MotorDrive::Close(_), .. } => (close, DriveSource::Wearer),
        // Slip while the line closes: the faster of both.
        Wishes { link: Some(MotorDrive::Close(link)), reflex: close @ MotorDrive::Close(own), .. }
            if own.as_per_mille() > link.as_per_mille() =>
        {
            (close, DriveSource::Reflex)
        }
        // Then a command that moves the hand. One to coast does not silence the reflex.
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

    /// Every wish of a source, told apart from the others' by its duty, which is only passed on.
    fn wishes(duty: u16) -> [MotorDrive; 3] {
        let duty = Duty::per_mille(duty);
        [MotorDrive::Coast, MotorDrive::Close(duty), MotorDrive::Open(duty)]
    }

    // Shows W1, W2.
    #[test]
    fn the_contract_over_every_combination() {
        let mut checked = 0;
        for wearer in wishes(1) {
            for link in [None].into_iter().chain([wishes(2), wishes(5)].concat().into_iter().map(Some)) {
                for (reflex, behaviour) in
                    wishes(3).into_iter().flat_map(|reflex| wishes(4).map(|behaviour| (reflex, behaviour)))
                {
                    for wearer_active in [false, true] {
                        check(Wishes { wearer_active, wearer, link, reflex, behaviour });
                        checked += 1;
                    }
                }
            }
        }
        assert_eq!(checked, 3 * 7 * 3 * 3 * 2);
    }

    fn check(wishes: Wishes) {
        let Wishes { wearer_active, wearer, link, reflex, behaviour } = wishes;
        let (drive, source) = arbitrate(wishes);
        let wearer_asks = wearer_active || wearer != MotorDrive::Coast;
        let link_opens = link.is_some_and(MotorDrive::opens) && !wearer_asks;
        let free = !wearer_asks && link.is_none_or(|link| link == MotorDrive::Coast);
        let behaves = free && !reflex.closes() && behaviour != MotorDrive::Coast;
        let is_faster = !wearer_asks && link == Some(MotorDrive::Close(Duty::per_mille(2)));
        let open_asked = wearer.opens() || link_opens || (behaves && behaviour.opens());
        assert_eq!(drive.opens(), open_asked, "nothing else opens, and nothing stops the wearer");
        let own = match source {
            DriveSource::Wearer => wearer,
            DriveSource::Link => link.unwrap_or_default(),
            DriveSource::Reflex => reflex,
            DriveSource::Behaviour => behaviour,
            DriveSource::Nobody => MotorDrive::Coast,
        };
        assert_eq!(drive, own, "as its source asked");
        assert_eq!(source == DriveSource::Wearer, wearer != MotorDrive::Coast);
        assert!(!(wearer_asks && source == DriveSource::Link));
        assert!(link != Some(MotorDrive::Coast) || source != DriveSource::Link);
        assert_eq!(source == DriveSource::Reflex, (free || is_faster) && reflex.closes());
        assert_eq!(source == DriveSource::Behaviour, behaves, "the reflex tightens what a behaviour loosens");
        assert!(!(wearer_active && matches!(source, DriveSource::Reflex | DriveSource::Behaviour)));
        assert!(source != DriveSource::Reflex || drive.closes());
        assert_eq!(source == DriveSource::Nobody, drive == MotorDrive::Coast);
    }
}
