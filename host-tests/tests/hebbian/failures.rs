//! Boundaries of the method and what remains beyond them: offsets, dead receptors, exchanged cables, bad teachers.

use tenax_logic::hebbian::{Activation, Activations, Code, Config, RECEPTORS};

use super::map::{Fate, UNSEEN, ask, fate, learned, teach};
use super::oracle::weights_of;
use super::task::{Finger, Moment};

fn felt_through(trial: &[Moment], change: impl Fn(&mut [Activation; RECEPTORS])) -> Vec<Moment> {
    trial
        .iter()
        .map(|moment| {
            let mut felt = moment.felt.as_bits().map(Activation::from_bits);
            change(&mut felt);
            Moment { felt: Activations::new(felt), ..*moment }
        })
        .collect()
}

/// Films die after learning: each takes its part and no more, nothing is said that is not so, and learning goes on.
// Shows R5.
#[test]
fn a_receptor_that_dies_takes_only_its_part() {
    let finger = Finger::new(1);
    let (lesson, trial) = (finger.lesson(), finger.trial(UNSEEN));
    let config = Config::default();
    let mut network = learned(&config, &lesson);
    let weights = weights_of(&network);
    let dead =
        |moments: &[Moment], films| felt_through(moments, |felt| felt[..films].fill(Activation::default()));
    for films in [0, 1, 3, 6, 9] {
        let said = ask(&weights, &dead(&trial, films));
        assert!(said.false_slip == 0.0 && said.direction > 0.99);
        assert!(films > 3 || said.slip_seen == 1.0);
    }
    let six_dead = dead(&trial, 6);
    let before = ask(&weights, &six_dead);
    teach(&mut network, &config, &dead(&lesson, 6));
    let after = ask(&weights_of(&network), &six_dead);
    assert!(after.o1_slip > before.o1_slip && after.slip_seen >= before.slip_seen);
}

/// A teacher that says the opposite turns a settled weight round in `ln 2 / beta`, 69 s at the default.
#[test]
fn a_wrong_teacher_is_survived_for_a_trial_and_forgotten() {
    let finger = Finger::new(1);
    let trial = finger.trial(UNSEEN);
    let mut network = learned(&Config::default(), &finger.lesson());
    let mut taught = |seeds: std::ops::Range<u64>, sign: i32| {
        for seed in seeds {
            let mut moments = finger.trial(seed);
            for moment in &mut moments {
                moment.seen = moment.seen.map(|code| Code::from_sign(sign * code.sign()));
            }
            teach(&mut network, &Config::default(), &moments);
        }
        weights_of(&network)
    };
    let said = ask(&taught(50..51, -1), &trial);
    assert!(said.direction > 0.99 && said.false_slip == 0.0 && said.slip_seen > 0.5, "{said:?}");
    assert!(ask(&taught(51..71, -1), &trial).direction < 0.01, "it does believe its teacher in the end");
    assert_eq!(fate(&taught(0..30, 1), &trial), Fate::Useful);
}

#[test]
fn twenty_fingers_learn_with_the_same_rates() {
    for seed in 0..20 {
        let finger = Finger::new(seed);
        let weights = weights_of(&learned(&Config::default(), &finger.lesson()));
        assert_eq!(fate(&weights, &finger.trial(UNSEEN)), Fate::Useful, "finger {seed}");
    }
}

/// Without the lowering, 'up' is taught twice as long as 'down': receptors of the grasp take part in the direction.
#[test]
fn lessons_that_say_up_more_than_down_spoil_the_direction() {
    let wrong = (0..20).filter(|&seed| {
        let finger = Finger::new(seed);
        let mut lesson = finger.lesson();
        lesson.retain(|m| m.seen != [Code::Plus, Code::Minus]);
        let weights = weights_of(&learned(&Config::default(), &lesson));
        ask(&weights, &finger.trial(UNSEEN)).direction < 0.99
    });
    assert_eq!(wrong.count(), 6, "of 20 fingers");
}
