//! The vibration motor that tells the wearer, and films that hear it.

use crate::common::{asked, parsed};
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::GripMode;
use tenax_scene::{SceneFile, World};
use tenax_sim::board::{Run, simulated};

const SCENES: [&str; 5] = ["glass", "wearer-control", "knocks", "pick-up-reflex", "gripper"];

#[derive(Clone, Copy, Debug)]
struct Drawn {
    film_mv: f64,
    full_hz: f64,
    spin_ms: f64,
    choice: u32,
}

/// Films that hear the motor with `least_mv` to ten times as much: the gear of the hand gives 1 mV.
fn drawn(n: usize, least_mv: f64) -> Drawn {
    let part = |step: f64| (0.5 + n as f64 * step).fract();
    Drawn {
        film_mv: least_mv * 10_f64.powf(part(0.618_034)),
        full_hz: 150.0 + 100.0 * part(0.754_878),
        spin_ms: 20.0 * 5_f64.powf(part(0.569_840)),
        choice: 1 + (n % 2) as u32,
    }
}

/// `base` with the motor, and films whose gains lie within a decade.
fn with(base: &str, Drawn { film_mv, full_hz, spin_ms, choice }: Drawn) -> SceneFile {
    parsed(&format!(
        "name = 'vibrates'\ntitle = 'V'\nbase = '{base}'\n[pvdf]\nfilm_decades = 1.0\n\
         [vibrator]\nfilm_mv = {film_mv}\nfull_hz = {full_hz}\nspin_ms = {spin_ms}\n\
         [[command]]\nat_s = 0.11\nkind = 'set-feedback-choice'\nvalue = {choice}\n"
    ))
}

fn ran(base: &str, drawn: Drawn, seed: u64) -> Run {
    simulated::run(World::new(&with(base, drawn), seed)).0
}

/// Duty of the motor over the run, per mille of full for its ticks, and the answers to slip.
fn done(run: &Run) -> (i64, usize) {
    let drives =
        run.slows.iter().flat_map(|slow| &slow.ticks).map(|tick| i64::from(tick.drive.signed_permille()));
    (drives.sum(), answers(run))
}

fn answers(run: &Run) -> usize {
    run.events.iter().filter(|event| matches!(event.kind, EventKind::Mode { to: GripMode::Slip, .. })).count()
}

/// Draws of each scene; `TENAX_SEEDS=10` covers the decade.
fn draws() -> usize {
    asked("TENAX_SEEDS").unwrap_or(2)
}

// Shows R11.
#[test]
fn no_slip_is_heard_of_it_and_the_hand_does_as_without_it() {
    let mut heard_at_all = 0;
    for base in SCENES {
        for n in 0..draws() {
            let (draw, seed) = (drawn(n, 1.0), 1 + n as u64 / 2);
            let deaf = ran(base, Drawn { film_mv: 0.0, ..draw }, seed);
            let vibrates = ran(base, draw, seed);
            let ((deaf_duty, slips), (duty, own_slips)) = (done(&deaf), done(&vibrates));
            let alike = (duty - deaf_duty).abs() <= deaf_duty.abs() / 100;
            assert!(slips == own_slips && alike, "{base}, seed {seed}, {draw:?}: {deaf_duty}, {duty}");
            assert_eq!(deaf.feedback, vibrates.feedback);
            assert!(!vibrates.feedback.is_empty(), "{base} tells nothing");
            let levels = |run: &Run| -> u64 {
                run.slows.iter().flat_map(|slow| &slow.ticks).map(|tick| u64::from(tick.vibration)).sum()
            };
            heard_at_all += usize::from(levels(&vibrates) > levels(&deaf));
        }
    }
    let runs = SCENES.len() * draws();
    assert!(10 * heard_at_all >= 9 * runs, "the films heard it in {heard_at_all} of {runs}");
}

// Shows R11.
#[test]
fn far_louder_it_is_answered_once_or_twice_and_does_not_feed_itself() {
    let mut answered = 0;
    for (base, least_mv) in SCENES.into_iter().flat_map(|base| [(base, 10.0), (base, 100.0)]) {
        for n in 0..draws() {
            let (draw, seed) = (drawn(n, least_mv), 1 + n as u64 / 2);
            let deaf = ran(base, Drawn { film_mv: 0.0, ..draw }, seed);
            let vibrates = ran(base, draw, seed);
            let more = answers(&vibrates).saturating_sub(answers(&deaf));
            assert!(more <= 2, "{base}, seed {seed}, {draw:?}: {more} more");
            // Each answer is told: on and off.
            assert!(
                vibrates.feedback.len() <= deaf.feedback.len() + 2 * more,
                "{base}, seed {seed}, {draw:?}"
            );
            answered += more;
        }
    }
    assert!(answered > 0, "the boundary of the test above is passed");
}
