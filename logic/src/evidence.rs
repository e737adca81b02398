//! Evidence of slip: one log-odds of what films, array and forces say, once a slow frame, and at once where a detector
//! reports slip by itself.
//!
//! Slip raises all films in the slip band and hardly above it; an impact and the motor raise both. The smaller
//! Ft/Fn, the fewer objects slide there. The weights are those of a logistic regression on drawn worlds without reflex (seeds 11
//! to 16: 628,420 readings, 1,116 of them within 50 ms of a slip's begin).

use crate::emg::level::{LEVEL_Q, log2};
use crate::force::friction::LEAST_PERMILLE;

/// Millinats an octave: rise of the films in the slip band over their own floors, the mean of all; of the noise above the
/// band, the loudest film's; Ft/Fn.
const RISE: i32 = 2_170;
const ABOVE: i32 = -1_340;
const RATIO: i32 = 1_480;
/// Beyond that below the least friction, which no world has: the force sensor would be wrong.
const NEVER: i32 = 10_000;
/// Per mille of the array's own log-odds, which count up to [`ARRAY_MOST`] millinats.
const ARRAY: i32 = 582;
const ARRAY_MOST: i32 = 7_270;
/// Millinats while the motor was loud within 100 ms, and of a constant.
const MOVES: i32 = -2_500;
const CONSTANT: i32 = -2_900;
/// What a sense is taken for that gives nothing, so that the others decide as they do in a regression without it:
/// millinats of the films, log-odds of the array, and Ft/Fn, per mille.
const NO_FILMS: i32 = 3_800;
const NO_ARRAY: i32 = -4_360;
const NO_RATIO_PERMILLE: u32 = 200;
/// Millinats that a detector's own report of slip is worth in place of the films' rise.
const REPORT: i32 = 10_000;
/// Log-odds from which it is slip, millinats: a slip that is missed costs more than a step without need.
const SLIPS: i32 = -1_500;
/// Certainty of a slip at that threshold, per mille, and millinats beyond it for each 1000.
const DOUBTED_PERMILLE: i32 = 350;
const SURE: i32 = 6_000;
/// Log-odds that slip, once it is answered, has before anything is heard, millinats: it lasts for many readings.
const LASTS: i32 = 3_000;

/// Levels over their own floors, octaves, Q10.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sound {
    pub rise: i16,
    pub above: i16,
}

#[derive(Clone, Copy, Debug, Default)]
pub struct Clues {
    /// None: no film gives a reading, or their floors are not known yet.
    pub sound: Option<Sound>,
    /// Log-odds, millinats. None: it gives no verdict.
    pub array: Option<i32>,
    pub ratio_permille: Option<u16>,
    /// The motor was loud within 100 ms.
    pub moves: bool,
    /// The reflex answers slip.
    pub answers: bool,
}

#[derive(Clone, Copy, Debug)]
pub struct LogOdds {
    films: i32,
    others: i32,
    /// The films are above their floors.
    hears: bool,
}

/// Before the first reading there is none.
impl Default for LogOdds {
    fn default() -> Self {
        Self { films: 0, others: -1_000_000, hears: false }
    }
}

impl LogOdds {
    pub fn weigh(&mut self, clues: &Clues) {
        let octaves = |weight: i32, level: i32| (weight * level) >> LEVEL_Q;
        self.hears = clues.sound.is_some_and(|sound| sound.rise > 0);
        self.films = clues.sound.map_or(NO_FILMS, |Sound { rise, above }| {
            octaves(RISE, rise.into()) + octaves(ABOVE, above.into())
        }) + if clues.moves { MOVES } else { 0 };
        let ratio = clues.ratio_permille.map_or(NO_RATIO_PERMILLE, u32::from).clamp(20, 2_000);
        let below = (log2(ratio) - log2(LEAST_PERMILLE.into())).min(0);
        let array = clues.array.unwrap_or(NO_ARRAY).clamp(-ARRAY_MOST, ARRAY_MOST);
        self.others = octaves(RATIO, log2(ratio) - log2(1_000))
            + octaves(NEVER, below)
            + array * ARRAY / 1_000
            + CONSTANT
            + if clues.answers { LASTS } else { 0 };
    }

    /// `reports`: so many detectors report slip by themselves.
    pub fn slips(&self, reports: i32) -> bool {
        self.odds(reports) > SLIPS
    }

    /// Slip that no detector reports. Films that give nothing are taken for as much as they tell on average, which is no sound.
    pub fn hears_slip(&self) -> bool {
        self.hears && self.slips(0)
    }

    /// How much of the first step against it a slip is worth, per mille.
    pub fn sure_permille(&self, reports: i32) -> i32 {
        let beyond = (self.odds(reports) - SLIPS).clamp(0, SURE);
        (DOUBTED_PERMILLE + beyond * 1_000 / SURE).min(1_000)
    }

    fn odds(&self, reports: i32) -> i32 {
        let heard = if reports > 0 { self.films.max(reports * REPORT) } else { self.films };
        heard + self.others
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [u16; 2] = [20, 2_000];

    fn weighed(clues: Clues) -> LogOdds {
        let mut evidence = LogOdds::default();
        assert!(!evidence.slips(3), "nothing is known yet");
        evidence.weigh(&clues);
        evidence
    }

    fn octaves(rise: f64, above: f64) -> Option<Sound> {
        Some([rise, above].map(|octaves| (octaves * f64::from(1 << LEVEL_Q)) as i16))
            .map(|[rise, above]| Sound { rise, above })
    }

    fn quiet(ratio_permille: u16) -> Clues {
        Clues {
            sound: octaves(0.5, 0.1),
            array: Some(-6_300),
            ratio_permille: Some(ratio_permille),
            ..Clues::default()
        }
    }

    #[test]
    fn a_report_counts_where_something_slides_and_two_count_below() {
        let least = |reports| {
            (ALL[0]..ALL[1]).find(|&ratio| weighed(quiet(ratio)).slips(reports)).unwrap_or(u16::MAX)
        };
        assert_eq!(least(0), u16::MAX, "nobody says anything");
        let [one, two] = [1, 2].map(least);
        assert!((90..140).contains(&one) && (30..60).contains(&two), "{one} {two} per mille");
        let felt = Clues { array: Some(4_000), ..quiet(60) };
        assert!(!weighed(quiet(60)).slips(1) && weighed(felt).slips(1), "the array feels it, too");
    }

    #[test]
    fn an_impact_that_rings_above_the_band_is_no_slip_and_a_quiet_slip_is() {
        let heard = |rise, above| Clues { sound: octaves(rise, above), ..quiet(250) };
        assert!(weighed(heard(4.5, 0.5)).slips(0), "20 times each film's floor");
        assert!(!weighed(heard(6.0, 5.0)).slips(0));
        assert!(!weighed(Clues { moves: true, ..heard(4.5, 0.5) }).slips(0), "the motor");
        let alone = Clues { sound: None, array: Some(3_500), ..quiet(250) };
        assert!(weighed(alone).slips(0), "without films the array decides");
        assert!(!weighed(Clues { sound: quiet(250).sound, ..alone }).slips(0), "which they contradict");
    }

    // Shows R4.
    #[test]
    fn films_that_give_nothing_or_no_rise_hear_no_slip_whatever_else_is_known() {
        for (sound, answers) in
            [None, octaves(0.0, 0.0), octaves(-0.5, 0.0)].map(|own| [(own, false), (own, true)]).concat()
        {
            for (array, ratio) in [None, Some(0), Some(7_000)].map(|own| [(own, 300), (own, 2_000)]).concat()
            {
                let clues = Clues { sound, array, ratio_permille: Some(ratio), moves: false, answers };
                assert!(!weighed(clues).hears_slip(), "{clues:?}");
            }
        }
        assert!(weighed(Clues { sound: octaves(4.5, 0.5), ..quiet(250) }).hears_slip());
    }

    #[test]
    fn more_of_a_clue_is_more_evidence_and_no_clue_overflows() {
        let levels = [i16::MIN, -1_024, 0, 512, 6_144, i16::MAX];
        let sounds = levels.map(|rise| levels.map(|above| Some(Sound { rise, above }))).concat();
        let arrays = [None, Some(i32::MIN), Some(-6_300), Some(0), Some(4_000), Some(i32::MAX)];
        let ratios = [0, 19, 69, 70, 130, 600, u16::MAX];
        for (sound, ratio) in
            sounds.into_iter().chain([None]).flat_map(|own| ratios.map(|ratio| (own, ratio)))
        {
            for (array, reports) in arrays.map(|array| [0, 1, 3].map(|reports| (array, reports))).concat() {
                let clues = Clues { sound, array, ratio_permille: Some(ratio), ..Clues::default() };
                let less = weighed(clues);
                assert!((DOUBTED_PERMILLE..=1_000).contains(&less.sure_permille(reports)));
                let louder = |Sound { rise, above }| Sound { rise: rise.saturating_add(99), above };
                let more = [
                    Clues { sound: sound.map(louder), ..clues },
                    Clues { array: array.map(|array| array.saturating_add(999)), ..clues },
                    Clues { ratio_permille: Some(ratio.saturating_add(9)), ..clues },
                    Clues { answers: true, ..clues },
                ];
                assert!(
                    more.iter().all(|&more| weighed(more).odds(reports) >= less.odds(reports)),
                    "{clues:?}"
                );
                assert!(less.odds(reports + 1) >= less.odds(reports));
            }
        }
    }
}
