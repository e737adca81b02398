//! The constants of the wearer's model, in one place.
//!
//! Model card. Fitted on: UniBo-INAIL envelopes of Ottobock 13E200 electrodes, persons 1 to 4, 4 days, 2 arm postures
//! (`../shared/data/myobock`), read 240 times a second as the board reads, calibrated from two repetitions of the same session.
//! How: a random search over a grid, scored by windows right, windows the wrong way, false motions at rest and latency; each
//! person counts alike. `LEAST_RISE`, `HYSTERESIS`, `LEAST_END`, `LEAST_FALL` and `PLACE_STAYS` of closing were then set by hand with the
//! two-channel recordings in view. Nobody was held apart. Not used: faults, scenes. `docs/emg.md` has what it scores on whom.

/// Readings over which shares and ratio are averaged: 0.13 s.
pub const MEAN_READINGS: i32 = 32;
/// Share of the calibrated rise from which opening and closing begin, per mille.
pub const BEGINS: [i32; 2] = [450, 600];
/// And below which each ends.
pub const ENDS: [i32; 2] = [450, 500];
/// A wish ends at least this far below where it begins, Q10 octaves; and no lower than this share.
pub const HYSTERESIS: i32 = 250;
/// See above.
pub const LEAST_END: i32 = 200;
/// It also ends this far below its own crest, per mille of the calibrated rise: a muscle that relaxes slowly has let go.
pub const FALL: i32 = 300;
/// But never for a fall of less than this, Q10 octaves: a contraction fluctuates.
pub const LEAST_FALL: i32 = 1_200;
/// The crest is forgotten over so many readings: 4 s.
pub const CREST_READINGS: i32 = 960;
/// And begins again this far above the lowest point since: tone that stays is no new wish.
pub const RISE: i32 = 400;
/// A wish begins at least this far above rest, Q10 octaves, and so many standard deviations of rest.
pub const LEAST_RISE: i32 = 600;
/// See above.
pub const LEAST_SPREADS: i32 = 3;
/// Place of the electrodes' ratio between calibrated closing (0) and opening (1000): closing begins below, opening above.
pub const PLACE_BEGINS: i32 = 480;
/// Closing goes on below, opening above.
pub const PLACE_STAYS: [i32; 2] = [520, 400];
/// Readings for which a wish stands before it is one: rest 25 ms, closing 38 ms, opening 75 ms.
pub const DWELL: [u16; 3] = [6, 9, 18];
/// A single reading above all that was calibrated opens after so many.
pub const AT_ONCE_READINGS: u16 = 2;
/// Readings over which rest is followed: 4.3 s.
pub const REST_READINGS: i32 = 1_024;
