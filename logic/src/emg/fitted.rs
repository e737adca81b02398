//! The constants of the wearer's model. `cargo tenax train emg --ship` replaces this file.
//!
//! Model card. Fitted on: UniBo-INAIL envelopes of Ottobock 13E200 electrodes, persons 1 to 4, 4 days, 2 arm postures
//! (`../shared/data/myobock`), read 240 times a second as the board reads, calibrated from two repetitions of the same session.
//! How: a random search over a grid, scored by windows right, windows the wrong way, false motions at rest and latency; each
//! person counts alike. `least_rise`, `hysteresis`, `least_end`, `least_fall` and `place_stays` of closing were then set by hand with the
//! two-channel recordings in view; so were `mean_frames`, `begins` of opening, `after_frames` and `busy`, one at a time: fewer false
//! motions for two of the four people, and more for none. Nobody was held apart. Not used: faults, scenes. `docs/emg.md` has what it
//! scores on whom.

use super::constants::Fitted;

/// The constants of the model that the image runs.
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
    place_begins: 480,
    place_stays: [520, 400],
    dwell: [2, 3, 6],
    rest_frames: 341,
    after_frames: [40, 80],
    after_dwell: 12,
    firmer: 270,
    both: 300,
    busy: 450,
};
