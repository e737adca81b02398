//! The constants of the wearer's model: their meaning here, their values in [`fitted`](super::fitted).

/// The constants with which the board recognises the wearer's wish. Shares and places are per mille of what was
/// calibrated, levels are Q10 octaves, times are slow frames, 80 a second.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fitted {
    /// Slow frames over which shares and ratio are averaged.
    pub mean_frames: i32,
    /// Share of the calibrated rise from which closing and opening begin.
    pub begins: [i32; 2],
    /// Share below which closing and opening end.
    pub ends: [i32; 2],
    /// A wish ends at least this far below where it begins.
    pub hysteresis: i32,
    /// Lowest share at which a wish ends.
    pub least_end: i32,
    /// A wish also ends this share below its highest one: a muscle that relaxes slowly has let go.
    pub fall: i32,
    /// Smallest fall of the level that ends a wish: a contraction fluctuates.
    pub least_fall: i32,
    /// Time constant with which the highest share is forgotten, slow frames.
    pub crest_frames: i32,
    /// A wish begins again this share above the lowest one since: tone that stays is no new wish.
    pub rise: i32,
    /// A wish begins at least this level above rest.
    pub least_rise: i32,
    /// A wish begins at least so many standard deviations of rest above rest.
    pub least_spreads: i32,
    /// Place of the electrodes' ratio between calibrated closing (0) and opening (1000): closing begins below, opening above.
    pub place_begins: i32,
    /// Closing goes on below, opening above.
    pub place_stays: [i32; 2],
    /// Slow frames for which rest, closing and opening must last before they are a wish.
    pub dwell: [i32; 3],
    /// Time constant with which the level of rest is followed, slow frames.
    pub rest_frames: i32,
    /// After a contraction the opposite muscle often contracts weakly for a while. So after other activity no opening begins for
    /// the first number of slow frames, and only a strong one for the second.
    pub after_frames: [i32; 2],
    /// For which closing stands as soon after opening.
    pub after_dwell: i32,
    /// Level above the calibrated opening from which nothing is a relaxing muscle.
    pub firmer: i32,
    /// Both muscles contract when the other site has a share above what calibration found beside the contraction, and this.
    pub both: i32,
    /// Share of either site that is activity.
    pub busy: i32,
}

impl Fitted {
    /// Number of constants.
    pub const COUNT: usize = 26;

    /// Each of them, in the order of the fields: for who fits them.
    pub fn all_mut(&mut self) -> [&mut i32; Self::COUNT] {
        let Self { mean_frames, begins, ends, hysteresis, least_end, fall, least_fall, .. } = self;
        let Self { crest_frames, rise, least_rise, least_spreads, place_begins, place_stays, .. } = self;
        let Self { dwell, rest_frames, after_frames, after_dwell, firmer, both, busy, .. } = self;
        let ([close_begins, open_begins], [close_ends, open_ends]) = (begins, ends);
        let ([close_stays, open_stays], [rest_dwell, close_dwell, open_dwell]) = (place_stays, dwell);
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
            rest_dwell,
            close_dwell,
            open_dwell,
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
