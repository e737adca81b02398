use super::*;
use std::f64::consts::TAU;
use std::vec::Vec;

const HZ: f64 = 240.0;

fn wearer() -> Emg {
    let model = EmgModel::of_uv([60_000, 50_000], [450_000, 165_000], [150_000, 1_400_000]).unwrap();
    Emg::new(Some(&model))
}

fn run(emg: &mut Emg, seconds: f64, of: impl Fn(f64) -> [f64; 2]) -> Vec<Verdict> {
    (0..(seconds * HZ) as u32)
        .map(|n| emg.take(of(f64::from(n) / HZ).map(|mv| Some((mv * 1e3) as i32))))
        .collect()
}

fn alive(mv: f64, t: f64) -> f64 {
    mv * (1.0 + 0.12 * (TAU * 2.7 * t).sin() + 0.1 * (TAU * 5.3 * t + 1.0).sin())
}

fn part(verdicts: &[Verdict], wish: Wish) -> f64 {
    verdicts.iter().filter(|verdict| verdict.wish == wish).count() as f64 / verdicts.len() as f64
}

fn rest(t: f64) -> [f64; 2] {
    [60.0 + 3.0 * (TAU * 3.0 * t).sin(), 50.0 + 3.0 * (TAU * 2.0 * t).sin()]
}

#[test]
fn a_contraction_moves_the_hand_its_way_and_rest_does_not() {
    let mut emg = wearer();
    let resting = run(&mut emg, 3.0, rest);
    assert!(resting.iter().all(|v| v.wish == Wish::Rest && !v.active));
    assert!(resting.iter().skip(2).all(|v| v.known));
    let closing = run(&mut emg, 2.0, |t| [alive(450.0, t), alive(160.0, t + 0.1)]);
    assert!(part(&closing, Wish::Close) > 0.9 && part(&closing, Wish::Open) == 0.0);
    assert!(closing.iter().skip(240).all(|v| v.proven));
    let between = run(&mut emg, 1.0, rest);
    assert!(!between.last().unwrap().active);
    let opening = run(&mut emg, 2.0, |t| [alive(150.0, t), alive(2_000.0, t)]);
    assert!(part(&opening, Wish::Open) > 0.9 && part(&opening, Wish::Close) == 0.0);
    assert!(opening.iter().skip(240).all(|v| v.proven));
    assert!(opening.iter().any(|v| v.strength_permille == 1_000));
}

#[test]
fn a_fist_is_activity_and_never_opens() {
    // Recorded fists have the extensor at up to 2.2 times the flexor; here up to 2.7, above a held extension.
    for [flexor, extensor] in [[500.0, 300.0], [500.0, 600.0], [500.0, 1_300.0], [700.0, 1_800.0]] {
        let mut emg = wearer();
        run(&mut emg, 1.0, rest);
        let fist = run(&mut emg, 3.0, |t| [alive(flexor, t), alive(extensor, t)]);
        assert_eq!(part(&fist, Wish::Open), 0.0, "{extensor} mV");
        assert!(fist.iter().skip(50).all(|v| v.active));
    }
}

#[test]
fn opening_wins_over_a_flexor_that_hums() {
    let mut emg = wearer();
    run(&mut emg, 1.2, |t| [500.0, rest(t)[1]]);
    assert_eq!(emg.quality(0), Quality::Flat);
    assert!(!emg.verdict().known);
    let opening = run(&mut emg, 1.0, |t| [500.0, alive(2_000.0, t)]);
    let opened = opening.iter().position(|v| v.wish == Wish::Open).unwrap();
    assert!(opened as f64 / HZ < 0.025, "{opened} readings");
    let mut emg = wearer();
    run(&mut emg, 1.0, rest);
    let opening = run(&mut emg, 1.0, |t| [500.0, alive(1_900.0, t).max(1_750.0)]);
    let opened = opening.iter().position(|v| v.wish == Wish::Open).unwrap();
    assert!(opened as f64 / HZ < 0.3, "{opened} readings");
}

#[test]
fn what_the_flexor_does_not_hear_is_never_proven() {
    let crest = |t: f64| [80.0, 50.0 + 1_750.0 * (-(t - 0.4).powi(2) / 0.015).exp()];
    let swings = |t: f64| [alive(90.0, t), 1_000.0 + 900.0 * (TAU * 1.3 * t).sin()];
    let creeps = |t: f64| [alive(90.0, t), (50.0 + 800.0 * t).min(2_840.0)];
    for (seconds, of) in [(1.0, crest as fn(f64) -> [f64; 2]), (18.0, swings), (5.0, creeps)] {
        let mut emg = wearer();
        run(&mut emg, 2.0, |t| [alive(90.0, t), rest(t)[1]]);
        let verdicts = run(&mut emg, seconds, of);
        assert!(verdicts.iter().any(|v| v.wish == Wish::Open), "or it shows nothing");
        assert!(verdicts.iter().all(|v| !v.proven), "{seconds} s");
    }
}

#[test]
fn saturation_goes_on_opening_and_permits_no_closing() {
    let mut emg = wearer();
    run(&mut emg, 1.0, rest);
    run(&mut emg, 0.5, |t| [alive(150.0, t), alive(2_000.0, t)]);
    let over = run(&mut emg, 3.0, |t| [alive(900.0, t), 3_000.0]);
    assert!(over.iter().all(|v| v.wish == Wish::Open));
    let mut emg = wearer();
    run(&mut emg, 1.0, rest);
    assert!(run(&mut emg, 3.0, |t| [alive(900.0, t), 3_000.0]).iter().all(|v| v.wish == Wish::Rest));
}

// Shows W5.
#[test]
fn a_faulty_flexor_hides_no_opening_and_leaves_none_unproven() {
    let faults: [fn(f64) -> f64; 4] =
        [|_| 3_000.0, |_| 2_900.0, |_| 500.0, |t| 450.0 - 450.0 * (TAU * 1.3 * t).cos()];
    for (n, flexor) in faults.into_iter().enumerate() {
        let mut emg = wearer();
        run(&mut emg, 1.0, rest);
        run(&mut emg, 2.9, |t| [flexor(t), rest(t)[1]]);
        // From a crest on. Of two that swing alone either may be the loose one.
        for (from_s, is_proven) in [(2.9, true), (3.9, n < 3)] {
            let opening = run(&mut emg, 0.8, |t| [flexor(from_s + t), alive(2_000.0, t)]);
            let begun = opening.iter().position(|v| v.wish == Wish::Open).unwrap();
            assert!(begun as f64 / HZ < 0.06 && part(&opening, Wish::Open) > 0.9, "{n} {from_s}: {begun}");
            assert_eq!(opening.last().unwrap().proven, is_proven, "{n} {from_s}");
            run(&mut emg, 0.2, |t| [flexor(from_s + 0.8 + t), rest(t)[1]]);
        }
    }
}

#[test]
fn a_gap_of_50_ms_is_bridged() {
    let mut emg = wearer();
    run(&mut emg, 1.0, rest);
    run(&mut emg, 0.5, |t| [alive(150.0, t), alive(2_000.0, t)]);
    for n in 0..60 {
        let verdict = emg.take([Some(150_000), None]);
        assert!(!verdict.known && (verdict.wish == Wish::Open || n >= 12), "{n} readings");
    }
    assert_eq!(emg.verdict().wish, Wish::Rest);
}

#[test]
fn steady_hum_and_tone_are_subtracted() {
    let mut emg = wearer();
    run(&mut emg, 35.0, |t| [rest(t)[0], alive(150.0, t)]);
    let opening = run(&mut emg, 2.0, |t| [alive(150.0, t), 150.0 + alive(1_500.0, t)]);
    assert!(part(&opening, Wish::Open) > 0.9, "{}", part(&opening, Wish::Open));
}

#[test]
fn without_calibration_only_what_cannot_be_mistaken_moves_the_hand() {
    for (pair, wish) in [
        ([500.0, 420.0], Wish::Rest),
        ([90.0, 1_180.0], Wish::Rest),
        ([300.0, 60.0], Wish::Rest),
        ([900.0, 150.0], Wish::Close),
        ([120.0, 2_400.0], Wish::Open),
    ] {
        let mut emg = Emg::default();
        run(&mut emg, 1.0, rest);
        let verdicts = run(&mut emg, 2.0, |t| [alive(pair[0], t), alive(pair[1], t)]);
        assert!(verdicts.iter().skip(40).all(|v| v.active));
        assert!(verdicts.iter().all(|v| v.wish == Wish::Rest || v.wish == wish), "{pair:?}");
        assert!((part(&verdicts, wish) > 0.5), "{pair:?}: {}", part(&verdicts, wish));
    }
}

/// Readings with a wish to open, none of them proven, under envelopes that reach both electrodes.
fn unproven_openings(rest_mv: f64, seconds: f64, of: impl Fn(f64) -> [f64; 2]) -> usize {
    let rest_uv = (rest_mv * 1e3) as i32;
    let model = EmgModel::of_uv([rest_uv; 2], [900_000, 95_000], [80_000, 560_000]).unwrap();
    let mut emg = Emg::new(Some(&model));
    run(&mut emg, 2.0, |_| [rest_mv; 2]);
    let verdicts = run(&mut emg, seconds, of);
    let openings = || verdicts.iter().filter(|v| v.wish == Wish::Open);
    assert!(openings().all(|v| !v.proven));
    openings().count()
}

#[test]
fn what_reaches_both_electrodes_at_once_is_never_proven() {
    let mut opened = [0; 2];
    for flexor_part in [0.05, 0.1, 0.3, 1.0] {
        for mv_per_s in [300.0, 500.0, 1_000.0, 3_000.0, 10_000.0, 30_000.0] {
            let creeps = |t: f64| [flexor_part, 1.0].map(|part| (50.0 + part * mv_per_s * t).min(3_000.0));
            opened[0] += unproven_openings(50.0, 12.0, creeps);
        }
    }
    let lifts = |t: f64| 1.0 - (-(t - 0.3).max(0.0) / 0.027).exp();
    let swings = |t: f64| 0.5 - 0.5 * (TAU * 0.9 * t).cos();
    for flexor_part in [0.05, 0.1, 0.2] {
        for of in [lifts as fn(f64) -> f64, swings] {
            let in_proportion = |t: f64| [flexor_part, 1.0].map(|part| 5.0 + part * 1_200.0 * of(t));
            opened[1] += unproven_openings(5.0, 8.0, in_proportion);
        }
    }
    assert!(opened.iter().all(|opened| *opened > 1_000), "or it shows nothing: {opened:?}");
}

#[test]
fn an_electrode_that_swings_and_is_not_heard_is_doubted() {
    for hz in [0.8, 1.3, 2.2, 7.0] {
        let swing = |t: f64| 0.5 - 0.5 * (TAU * hz * t).cos();
        let mut emg = wearer();
        run(&mut emg, 2.0, rest);
        run(&mut emg, 3.0, |t| [rest(t)[0], 50.0 + 800.0 * swing(t)]);
        assert_eq!([emg.quality(0), emg.quality(1)], [Quality::Good, Quality::LeadOff], "{hz} Hz");
        run(&mut emg, 3.5, rest);
        assert_eq!(emg.quality(1), Quality::Good);
        run(&mut emg, 6.0, |t| [60.0 + 90.0 * swing(t), 50.0 + 800.0 * swing(t)]);
        assert_eq!([emg.quality(0), emg.quality(1)], [Quality::Good; 2], "{hz} Hz");
    }
}

// Shows W5.
#[test]
fn a_restless_electrode_is_told_within_5_s_is_never_proven_and_hides_no_opening() {
    let levels =
        [0.3, 0.6, 1.0].into_iter().flat_map(|share| [0.0, 0.02, 0.05, 0.1].map(|ripple| (share, ripple)));
    for (share, ripple, hz) in
        levels.flat_map(|(share, ripple)| [0.05, 0.7, 5.0].map(|hz| (share, ripple, hz)))
    {
        let mv = 90.0 * (480.0f64 / 90.0).powf(share) - 30.0;
        let stuck = |t: f64| mv * (1.0 + ripple * (TAU * hz * t).sin());
        let mut emg = wearer();
        run(&mut emg, 2.0, rest);
        let alone = run(&mut emg, 5.0, |t| [stuck(t), rest(t)[1]]);
        assert!(alone.iter().all(|v| !v.proven && v.wish != Wish::Open), "{share} {ripple} {hz}");
        assert_ne!(emg.quality(0), Quality::Good, "{share} {ripple} {hz}");
        let after = run(&mut emg, 1.0, |t| [stuck(t), rest(t)[1]]);
        assert!(after.iter().all(|v| v.wish == Wish::Rest), "{share} {ripple} {hz}");
        let opening = run(&mut emg, 2.0, |t| [stuck(t), alive(2_000.0, t)]);
        let begun = opening.iter().position(|v| v.wish == Wish::Open).unwrap();
        assert!(begun as f64 / HZ < 0.06 && part(&opening, Wish::Open) > 0.9, "{share} {ripple} {hz}");
        assert!(opening.iter().any(|v| v.proven), "{share} {ripple} {hz}");
        run(&mut emg, 2.0, rest);
        assert_eq!(emg.quality(0), Quality::Good);

        let mv = 80.0 * (1_430.0f64 / 80.0).powf(share) - 30.0;
        let mut emg = wearer();
        run(&mut emg, 2.0, rest);
        let alone = run(&mut emg, 5.0, |t| [rest(t)[0], mv * (1.0 + ripple * (TAU * hz * t).sin())]);
        assert!(alone.iter().all(|v| !v.proven && v.wish != Wish::Close), "{share} {ripple} {hz}");
        assert_ne!(emg.quality(1), Quality::Good, "{share} {ripple} {hz}");
    }
}

// Shows W5.
#[test]
fn two_electrodes_that_wander_apart_are_told_within_5_s_and_two_that_relax_together_are_not() {
    let told = |seconds: f64, of: &dyn Fn(f64) -> [f64; 2]| {
        let mut emg = wearer();
        run(&mut emg, 2.0, rest);
        run(&mut emg, seconds, of);
        [0, 1].map(|n| emg.quality(n) != Quality::Good)
    };
    for hz in [[0.05, 0.7], [0.7, 3.1], [5.0, 0.3]] {
        let wanders = |n: usize, t: f64| 1.0 + 0.075 * (TAU * hz[n] * t).sin();
        assert_eq!(told(5.0, &|t| [400.0 * wanders(0, t), 1_000.0 * wanders(1, t)]), [true; 2], "{hz:?}");
    }
    // Less than what an electrode alone is believed for.
    let relaxes =
        |t: f64| 1.0 + 0.03 * (TAU * 2.7 * t).sin() - 0.15 * (-((t % 3.0 - 1.5) / 0.2).powi(2)).exp();
    assert_eq!(told(20.0, &|t| [450.0, 1_000.0].map(|mv| mv * relaxes(t))), [false; 2]);
}

// Shows W5.
#[test]
fn a_flexor_that_sticks_as_a_closing_ends_closes_no_longer() {
    let mut emg = wearer();
    run(&mut emg, 2.0, rest);
    let closing = run(&mut emg, 2.0, |t| [alive(450.0, t), alive(160.0, t + 0.1)]);
    assert!(closing.last().unwrap().proven);
    let sticks = run(&mut emg, 3.0, |t| [450.0 * (1.0 + 0.04 * (TAU * t).sin()), rest(t)[1]]);
    let proven = sticks.iter().filter(|v| v.proven && v.wish == Wish::Close).count();
    assert!(proven as f64 / HZ < 1.2, "{proven}");
    assert_eq!(emg.quality(0), Quality::Endless);
}

#[test]
fn where_an_envelope_stands_still_no_muscle_is_at_work() {
    let mut emg = wearer();
    run(&mut emg, 0.9, |t| [500.0, rest(t)[1]]);
    assert!(!emg.is_idle(0, 500_000) && emg.is_idle(0, 60_000), "still not long enough");
    run(&mut emg, 0.3, |t| [500.0, rest(t)[1]]);
    assert!(emg.is_idle(0, 500_000) && emg.is_idle(0, 520_000) && !emg.is_idle(0, 700_000));
}

// Shows W5.
#[test]
fn a_flexor_that_never_rests_is_told_without_calibration_too() {
    let mut emg = Emg::default();
    run(&mut emg, 1.0, rest);
    let stuck = run(&mut emg, 6.0, |t| [1_850.0 * (1.0 + 0.03 * (TAU * 4.0 * t).sin()), rest(t)[1]]);
    assert!(stuck.iter().any(|v| v.wish == Wish::Close), "or it shows nothing");
    assert!(stuck.iter().all(|v| !v.proven) && stuck.iter().skip(1_200).all(|v| v.wish == Wish::Rest));
    assert_eq!([emg.quality(0), emg.quality(1)], [Quality::Endless, Quality::Good]);
    run(&mut emg, 2.0, rest);
    assert_eq!(emg.quality(0), Quality::Good);
}

#[test]
fn a_closing_whose_other_electrode_stays_at_rest_is_proven_by_its_wide_band() {
    let mut emg = wearer();
    run(&mut emg, 2.0, rest);
    let wide = |t: f64| 450.0 * (1.0 + 0.35 * (TAU * 1.5 * t).sin());
    let closing = run(&mut emg, 10.0, |t| [wide(t), rest(t)[1]]);
    assert!(closing.iter().skip(480).all(|v| v.wish == Wish::Close && v.proven));
    assert_eq!(emg.quality(0), Quality::Good);
}

#[test]
fn what_an_electrode_that_swings_alone_wishes_is_not_proven_though_it_is_heard_then() {
    let swing = |t: f64| 0.5 - 0.5 * (TAU * 1.3 * t).cos();
    for swings in [false, true] {
        let mut emg = wearer();
        run(&mut emg, 2.0, rest);
        // Below what opens, so that no wish makes the next harder to believe.
        run(&mut emg, 3.0, |t| [rest(t)[0], if swings { 50.0 + 800.0 * swing(t) } else { rest(t)[1] }]);
        let opening = run(&mut emg, 1.5, |t| [alive(200.0, t), alive(2_000.0, t)]);
        assert!(part(&opening, Wish::Open) > 0.5, "{swings}");
        assert_eq!(opening.iter().any(|v| v.proven), !swings);
    }
}

#[test]
fn what_wavers_about_the_end_of_the_range_is_doubted() {
    for channel in 0..2 {
        let mut emg = wearer();
        run(&mut emg, 2.0, rest);
        run(&mut emg, 2.0, |t| {
            let mv = 2_950.0 + 40.0 * (TAU * 80.0 * t + 1.0).sin();
            if channel == 0 { [mv, rest(t)[1]] } else { [rest(t)[0], mv] }
        });
        assert_eq!(emg.quality(channel), Quality::Saturated);
        assert!(!emg.is_known(channel), "{channel}");
    }
}
