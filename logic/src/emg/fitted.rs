//! The constants of the wearer's model. `cargo tenax train emg --ship` replaces this file.
//!
//! Model card. Fitted on UniBo-INAIL envelopes of Ottobock 13E200 electrodes, persons 1 to 4, 4 days, 2 arm
//! postures, read 240 times a second, calibrated from two repetitions of the same session: a random search
//! over a grid, scored by windows right, windows the wrong way, false motions at rest and latency. Several
//! constants were then set by hand, `place_begins` and the dwell of ripple on an armband, too. Nobody was held
//! apart. Faults and scenes were not used. `docs/emg.md` has the scores.

use super::constants::Fitted;

pub static FITTED: Fitted = Fitted {
    mean_frames: 10,
    begins: [450, 690],
    ends: [450, 500],
    hysteresis: 250,
    least_end: 200,
    fall: 300,
    least_fall: 1_200,
    crest_frames: 320,
    rise: 400,
    least_rise: 600,
    least_spreads: 3,
    place_begins: 505,
    place_stays: [520, 400],
    dwell: [2, 6, 3, 6],
    rest_frames: 341,
    after_frames: [40, 80],
    after_dwell: 12,
    firmer: 270,
    both: 300,
    busy: 450,
};
