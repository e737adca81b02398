//! The constants of the wearer's model: their meaning here, their values in [`fitted`](super::fitted).

/// Shares and places are per mille of what was calibrated, levels Q10 octaves, times slow frames (80 a
/// second). Pairs are closing and opening.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fitted {
    pub mean_frames: i32,
    pub begins: [i32; 2],
    pub ends: [i32; 2],
    pub hysteresis: i32,
    pub least_end: i32,
    /// Fall from the highest share that ends a wish: a muscle that relaxes slowly has let go.
    pub fall: i32,
    pub least_fall: i32,
    pub crest_frames: i32,
    /// Rise above the lowest share since, from which a wish begins again: tone that stays is no new wish.
    pub rise: i32,
    pub least_rise: i32,
    pub least_spreads: i32,
    /// Place of the electrodes' ratio, closing at 0, opening at 1000: closing begins below, opening above.
    pub place_begins: i32,
    /// Place below which closing goes on, and above which opening does.
    pub place_stays: [i32; 2],
    /// Time for which a wish has to stand: rest, rest after a closing whose place still fits, closing, opening.
    pub dwell: [i32; 4],
    pub rest_frames: i32,
    /// Time after other activity in which no opening begins, and in which only a strong one does.
    pub after_frames: [i32; 2],
    pub after_dwell: i32,
    /// Level above the calibrated opening from which nothing is a relaxing muscle.
    pub firmer: i32,
    /// Share of the other site, above the calibrated one, from which both contract.
    pub both: i32,
    pub busy: i32,
}

impl Fitted {
    pub const COUNT: usize = 27;

    pub fn all_mut(&mut self) -> [&mut i32; Self::COUNT] {
        let Self { mean_frames, begins, ends, hysteresis, least_end, fall, least_fall, .. } = self;
        let Self { crest_frames, rise, least_rise, least_spreads, place_begins, place_stays, .. } = self;
        let Self { dwell, rest_frames, after_frames, after_dwell, firmer, both, busy, .. } = self;
        let ([close_begins, open_begins], [close_ends, open_ends]) = (begins, ends);
        let ([close_stays, open_stays], [rest, ripple, close, open]) = (place_stays, dwell);
        let [after, long_after] = after_frames;
        [
            mean_frames,
            close_begins,
            open_begins,
            close_ends,
            open_ends,
            hysteresis,
            least_end,
            fall,
            least_fall,
            crest_frames,
            rise,
            least_rise,
            least_spreads,
            place_begins,
            close_stays,
            open_stays,
            rest,
            ripple,
            close,
            open,
            rest_frames,
            after,
            long_after,
            after_dwell,
            firmer,
            both,
            busy,
        ]
    }
}

impl Default for &Fitted {
    fn default() -> Self {
        &super::fitted::FITTED
    }
}
