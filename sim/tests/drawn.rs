//! Worlds that are drawn: the same ones for the same seed, none absurd, and a hand that leaves them to the wearer.

use tenax_scene::drawn::{Drawn, Family, nth};
use tenax_sim::drawn::{Report, Score, scores};
use tenax_sim::report::bound::SAME_MM;

const SEED: u64 = 1;
const COUNT: u32 = 40;

/// All numbers of this key, in the order of the file.
fn numbers(text: &str, key: &str) -> Vec<f64> {
    let of = |line: &str| line.strip_prefix(key)?.strip_prefix(" = ")?.parse().ok();
    text.lines().filter_map(of).collect()
}

#[test]
fn drawn_worlds_are_sane_and_their_scores_hold_together() {
    for n in 0..25 * COUNT {
        let drawn = nth(None, SEED, n);
        assert_eq!(drawn, nth(Some(drawn.family), SEED, drawn.index), "drawn alone or in turn");
        let file = drawn.scene().unwrap_or_else(|error| panic!("{error}\n{}", drawn.text));
        assert!((5.0..30.0).contains(&file.duration_s()), "{} s", file.duration_s());
        let one = |key| numbers(&drawn.text, key)[0];
        assert!(one("width_mm") + 5.0 <= one("opening_mm") + 1e-3);
        assert!((0.0017..=1.5).contains(&one("mass_kg")) && (15.0..=140.0).contains(&one("force_n")));
        let [statics, slidings] = ["mu_s", "mu_d"].map(|key| numbers(&drawn.text, key));
        assert!(statics.iter().zip(&slidings).all(|(mu_s, mu_d)| mu_d <= mu_s && *mu_d >= 0.05));
    }
    assert_ne!(nth(None, SEED, 0).text, nth(None, SEED + 1, 0).text);
    for n in 0..10 * COUNT {
        let drawn = Drawn::hold(SEED, n, 10);
        let file = drawn.scene().unwrap_or_else(|error| panic!("{error}\n{}", drawn.text));
        assert!((600.0..630.0).contains(&file.duration_s()), "{} s", file.duration_s());
    }

    let first = scores(None, SEED, COUNT, &|_| {}).unwrap();
    assert_eq!(first[..8], scores(None, SEED, 8, &|_| {}).unwrap(), "the same world, the same score");
    assert_eq!(first.iter().map(|score| score.reflex_while_active).sum::<u64>(), 0, "the wearer first");
    // Who knows the future presses no harder than who does not and lets nothing slide either.
    let unslid = |score: &&Score| score.accepted && score.slid_mm_oracle < SAME_MM;
    let ordered: Vec<&Score> = first.iter().filter(unslid).collect();
    assert!(ordered.len() > 10);
    for score in ordered {
        let needed_n = score.needed_n.unwrap();
        assert!(0.98 * needed_n <= score.peak_n_oracle, "{score:?}");
    }
    let report = Report::new(SEED, &first).unwrap();
    assert_eq!(report.families.len(), Family::ALL.len());
    assert!((0.02..0.5).contains(&report.total.rejected), "{}", report.total.rejected);
}
