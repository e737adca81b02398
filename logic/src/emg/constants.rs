//! The constants of the wearer's model: their meaning here, their values in [`fitted`](super::fitted).

/// Shares and places are per mille of what was calibrated, levels Q10 octaves, times readings of a pair, 240 a second.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fitted {
    /// Over which shares and ratio are averaged.
    pub mean_readings: i32,
    /// Share of the calibrated rise from which closing and opening begin.
    pub begins: [i32; 2],
    /// And below which each ends.
    pub ends: [i32; 2],
    /// It also ends this far below its own crest, as a share: a muscle that relaxes slowly has let go.
    pub fall: i32,
    /// But never for a fall of less than this level: a contraction fluctuates.
    pub least_fall: i32,
    /// Over which the crest is forgotten.
    pub crest_readings: i32,
    /// A wish begins again this share above the lowest one since: tone that stays is no new wish.
    pub rise: i32,
    /// Place of the electrodes' ratio between calibrated closing (0) and opening (1000): closing begins below, opening above.
    pub place_begins: i32,
    /// Closing goes on below, opening above.
    pub place_stays: [i32; 2],
    /// For which closing and opening stand before they are a wish.
    pub dwell: [i32; 2],
    /// Readings above all that was calibrated that open at once.
    pub at_once_readings: i32,
    /// Over which rest is followed.
    pub rest_readings: i32,
    /// Who lets go of a contraction makes the opposite one for a while, somewhat weaker. So for so long after activity of another
    /// direction opening does not begin, for so long only a strong one does.
    pub after_readings: [i32; 2],
    /// For which closing stands as soon after opening.
    pub after_dwell: i32,
    /// Level above the calibrated opening from which nothing is a relaxing muscle.
    pub firmer: i32,
    /// Both muscles contract when the other site has a share above what calibration found beside the contraction, and this.
    pub both: i32,
}

impl Fitted {
    /// How many there are.
    pub const COUNT: usize = 21;

    /// Each of them: for who fits them.
    pub fn all_mut(&mut self) -> [&mut i32; Self::COUNT] {
        let Self {
            mean_readings, begins: [a, b], ends: [c, d], fall, least_fall, crest_readings, rise, ..
        } = self;
        let Self {
            place_begins, place_stays: [e, f], dwell: [g, h], at_once_readings, rest_readings, ..
        } = self;
        let Self { after_readings: [i, j], after_dwell, firmer, both, .. } = self;
        [
            mean_readings,
            a,
            b,
            c,
            d,
            fall,
            least_fall,
            crest_readings,
            rise,
            place_begins,
            e,
            f,
            g,
            h,
            at_once_readings,
            rest_readings,
            i,
            j,
            after_dwell,
            firmer,
            both,
        ]
    }
}
