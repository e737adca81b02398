//! The reflex's state machine (Prosthesis, figure 9): every legal step is one row of a table.

use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::words::{Cause, GripMode};

use Cause::{
    Incipient as Warned, PulseOver, Released, SensorsLost, SensorsReady, Settled, Slip as Slips, TakenOver,
};
use GripMode::{Incipient, Settle, Slip, Standby, Watch, Wearer};

const ANY: DetectorId = DetectorId::S1;

/// Every legal step, the same for every detector: from, why, to. A cause without a row changes nothing.
/// [`Slip`] and [`Incipient`], the only two that close the hand, are entered from [`Watch`] alone (and
/// [`Slip`] from [`Incipient`]); [`Watch`] is left for [`Wearer`] or [`Standby`] before a detector is asked.
pub const TRANSITIONS: [(GripMode, Cause, GripMode); 17] = [
    (Standby, SensorsReady, Watch),
    (Wearer, SensorsLost, Standby),
    (Wearer, Released, Settle),
    (Watch, SensorsLost, Standby),
    (Watch, TakenOver, Wearer),
    (Watch, Slips(ANY), Slip),
    (Watch, Warned(ANY), Incipient),
    (Slip, SensorsLost, Standby),
    (Slip, TakenOver, Wearer),
    (Slip, PulseOver, Settle),
    (Incipient, SensorsLost, Standby),
    (Incipient, TakenOver, Wearer),
    (Incipient, Slips(ANY), Slip),
    (Incipient, PulseOver, Watch),
    (Settle, SensorsLost, Standby),
    (Settle, TakenOver, Wearer),
    (Settle, Settled, Watch),
];

const MODES: usize = Settle as usize + 1;
const CAUSES: usize = 8;

const fn index(cause: Cause) -> usize {
    match cause {
        SensorsReady => 0,
        SensorsLost => 1,
        TakenOver => 2,
        Released => 3,
        Slips(_) => 4,
        Warned(_) => 5,
        PulseOver => 6,
        Settled => 7,
    }
}

static NEXT: [[Option<GripMode>; CAUSES]; MODES] = {
    let mut next = [[None; CAUSES]; MODES];
    let mut row = 0;
    while row < TRANSITIONS.len() {
        let (from, cause, to) = TRANSITIONS[row];
        next[from as usize][index(cause)] = Some(to);
        row += 1;
    }
    next
};

pub const fn next(from: GripMode, cause: Cause) -> Option<GripMode> {
    NEXT[from as usize][index(cause)]
}

pub const fn closes(mode: GripMode) -> bool {
    matches!(mode, Slip | Incipient)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIGURE: [&str; MODES] = [
        "W.......", // Standby
        ".S.E....", // Wearer
        ".SU.LI..", // Watch
        ".SU...E.", // Slip
        ".SU.L.W.", // Incipient
        ".SU....W", // Settle
    ];

    // Shows R1.
    #[test]
    fn every_mode_goes_on_as_drawn_with_every_cause() {
        let ids = [DetectorId::S1, DetectorId::S2];
        for ((from, steps), (n, id)) in
            GripMode::ALL.into_iter().zip(FIGURE).flat_map(|row| ids.map(|id| (row, (row.0 as usize, id))))
        {
            let causes =
                [SensorsReady, SensorsLost, TakenOver, Released, Slips(id), Warned(id), PulseOver, Settled];
            for (cause, letter) in causes.into_iter().zip(steps.chars()) {
                let to = "SUWLIE".find(letter).map(|place| GripMode::ALL[place]);
                assert_eq!(next(from, cause), to, "{from:?}, {cause:?}");
            }
            assert_eq!(closes(from), n == 3 || n == 4, "{from:?}");
        }
    }
}
