//! Where it fails, and what is left then: offsets, dead receptors, swapped cables, bad teachers, no teacher.

use tenax_logic::hebbian::{
    Activation, Activations, Code, Codes, Config, FingertipNetwork, NoLesson, Normaliser, NormaliserConfig,
    RECEPTORS, Rule, Sense, Situation, Teacher, TeacherConfig,
};

use super::map::{Fate, Said, UNSEEN, ask, correlations, fate, largest_part, learned, teach};
use super::oracle::{Rates, Reference, exact, fixed_point, weights_of};
use super::task::{Finger, Moment, OFFSET, VIBRATION};

/// The same trial, felt through other receptors.
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

fn line(what: &str, said: Said) {
    println!(
        "{what:34} |o1| in slip {:.2}, slip seen {:3.0} %, false {:3.0} %, direction {:3.0} %",
        said.o1_slip,
        100.0 * said.slip_seen,
        100.0 * said.false_slip,
        100.0 * said.direction
    );
}

/// The part of an output's weights that the offset receptor has.
fn offset_part(row: &[f64; RECEPTORS]) -> f64 {
    row[OFFSET].abs() / row.iter().map(|w| w.abs()).sum::<f64>()
}

/// Equations 5 and 6 in f64, with r and without.
fn offset_parts(lesson: &[Moment], delta: f64, with_r: bool) -> [f64; 2] {
    let rates = Rates { delta, with_r, ..Rates::from(&Config::default()) };
    // Without r the steps are larger: the parts are compared, not the sizes.
    let mut network = Reference::default();
    for moment in (0..5).flat_map(|_| lesson) {
        if let Some(codes) = moment.lesson() {
            network.learn(&rates, &exact(&moment.felt), &codes);
        }
    }
    network.weights.each_ref().map(offset_part)
}

/// An offset's correlation is the mean of v. If that is small beside the best correlation, r suppresses the offset, the
/// more the smaller delta is. A one-sided teacher makes it the best correlation of all, and r strengthens it.
#[test]
fn r_suppresses_an_offset_only_if_the_teacher_is_balanced() {
    let mut lesson = Finger::new(1).lesson();
    let one_sided: Vec<_> = lesson.iter().filter(|m| m.seen == [Code::Plus; 2]).copied().collect();
    // A third of the lowering is not seen: the mean of v1 is -0.09.
    let mut n = 0;
    lesson.retain(|m| {
        n += 1;
        m.seen != [Code::Plus, Code::Minus] || n % 3 > 0
    });
    let [balanced, biased] = [&lesson, &one_sided].map(|lesson| {
        let [without, _] = offset_parts(lesson, 1.0, false);
        let with = [3.0, 0.3, 0.01].map(|delta| offset_parts(lesson, delta, true)[0]);
        println!("offset's part of o1: without r {without:.3}, with r and delta 3, 0.3, 0.01 {with:.3?}");
        (without, with)
    });
    assert!(balanced.0 > balanced.1[0] && balanced.1[0] > balanced.1[1] && balanced.1[1] > balanced.1[2]);
    assert!(balanced.1[2] < 0.6 * balanced.0, "{balanced:?}");
    assert!(biased.1[2] > 1.5 * biased.0, "{biased:?}");
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
        line(&format!("{films} films dead"), said);
        assert!(said.false_slip == 0.0 && said.direction > 0.99);
        assert!(films > 3 || said.slip_seen == 1.0);
    }
    let six_dead = dead(&trial, 6);
    let before = ask(&weights, &six_dead);
    teach(&mut network, &config, &dead(&lesson, 6));
    let after = ask(&weights_of(&network), &six_dead);
    line("6 dead, after another lesson", after);
    assert!(after.o1_slip > before.o1_slip && after.slip_seen >= before.slip_seen);
}

/// A small delta gives one receptor nearly everything: it is the runaway of the map, and its death is the network's.
#[test]
fn after_a_runaway_one_death_is_the_end_of_direction() {
    let finger = Finger::new(1);
    let rates = Rates { delta: 0.001, ..Rates::from(&Config::default()) };
    let row = fixed_point(&rates, &correlations(&finger.lesson())[1]);
    let strongest = (0..RECEPTORS).max_by(|&a, &b| row[a].abs().total_cmp(&row[b].abs())).unwrap();
    println!("the strongest connection of o2 has {:.2} of all", largest_part(&row));
    assert!(largest_part(&row) > 0.9);
    let trial = felt_through(&finger.trial(UNSEEN), |felt| felt[strongest] = Default::default());
    let size = |trial: &[Moment]| {
        trial
            .iter()
            .map(|m| exact(&m.felt).iter().zip(row).map(|(t, w)| t * w).sum::<f64>().abs())
            .sum::<f64>()
    };
    assert!(size(&trial) < 0.1 * size(&finger.trial(UNSEEN)));
}

/// Two cables swapped after learning: a film's with the gauge that says most about direction.
#[test]
fn swapped_cables_are_learned_again() {
    let finger = Finger::new(1);
    let config = Config::default();
    let mut network = learned(&config, &finger.lesson());
    let weights = weights_of(&network);
    let strongest = |row: &[f64; RECEPTORS], from: std::ops::Range<usize>| {
        from.max_by(|&a, &b| row[a].abs().total_cmp(&row[b].abs())).unwrap()
    };
    let (film, gauge) = (strongest(&weights[0], 0..VIBRATION), strongest(&weights[1], VIBRATION..RECEPTORS));
    let swap = |moments: &[Moment]| felt_through(moments, |felt| felt.swap(film, gauge));
    let trial = swap(&finger.trial(UNSEEN));
    line("straight", ask(&weights, &finger.trial(UNSEEN)));
    line("swapped", ask(&weights, &trial));
    let mut trials = 0;
    while weights_of(&network)[1][film].abs() < weights_of(&network)[1][gauge].abs() {
        teach(&mut network, &config, &swap(&finger.trial(100 + trials)));
        trials += 1;
        assert!(trials < 30, "never learned again");
    }
    line(&format!("after {trials} trials more"), ask(&weights_of(&network), &trial));
    assert_eq!(fate(&weights_of(&network), &trial), Fate::Useful);
}

/// All the cables of the films swapped with all those of the gauges: nothing is right, and all is learned again.
#[test]
fn a_plug_put_in_the_wrong_way_is_learned_again() {
    let finger = Finger::new(1);
    let config = Config::default();
    let mut network = learned(&config, &finger.lesson());
    let swap = |moments: &[Moment]| felt_through(moments, |felt| felt.rotate_left(VIBRATION));
    let trial = swap(&finger.trial(UNSEEN));
    line("plug the wrong way", ask(&weights_of(&network), &trial));
    assert_ne!(fate(&weights_of(&network), &trial), Fate::Useful);
    let mut trials = 0;
    while fate(&weights_of(&network), &trial) != Fate::Useful {
        teach(&mut network, &config, &swap(&finger.trial(100 + trials)));
        trials += 1;
        assert!(trials < 30, "never learned again");
    }
    line(&format!("after {trials} trials more"), ask(&weights_of(&network), &trial));
}

/// A teacher that says the opposite: `ln 2 / beta` of it turns a settled weight round, 69 s at the default.
#[test]
fn a_wrong_teacher_is_survived_for_a_while_and_forgotten() {
    let finger = Finger::new(1);
    let config = Config::default();
    let trial = finger.trial(UNSEEN);
    let taught_ms = trial.iter().filter(|m| m.lesson().is_some()).count();
    let inverted = |seed| {
        let mut moments = finger.trial(seed);
        for moment in &mut moments {
            moment.seen = moment.seen.map(|code| Code::from_sign(-code.sign()));
        }
        moments
    };
    let mut network = learned(&config, &finger.lesson());
    line("taught", ask(&weights_of(&network), &trial));
    teach(&mut network, &config, &inverted(50));
    line(&format!("wrong for {taught_ms} ms"), ask(&weights_of(&network), &trial));
    let said = ask(&weights_of(&network), &trial);
    assert!(said.direction > 0.99 && said.false_slip == 0.0 && said.slip_seen > 0.5, "{said:?}");
    for seed in 51..71 {
        teach(&mut network, &config, &inverted(seed));
    }
    line("wrong for 21 trials", ask(&weights_of(&network), &trial));
    assert!(ask(&weights_of(&network), &trial).direction < 0.01, "it does believe its teacher in the end");
    for seed in 0..30 {
        teach(&mut network, &config, &finger.trial(seed));
    }
    line("taught well again for 30", ask(&weights_of(&network), &trial));
    assert_eq!(fate(&weights_of(&network), &trial), Fate::Useful);
}

/// A day of use: an hour without a teacher, an hour with one that sees nothing move, an hour of impacts.
#[test]
fn without_a_lesson_nothing_is_forgotten() {
    let config = TeacherConfig::default();
    let rule = Rule::new(&Config::default()).unwrap();
    let mut network = learned(&Config::default(), &Finger::new(1).lesson());
    let before = network.clone();
    let felt = Finger::new(1).trial(UNSEEN)[0].felt;
    let mut hour = |codes: Option<Codes>, disturbed, reason| {
        let mut teacher = Teacher::default();
        for ms in 0..3_600_000u32 {
            if ms % 33 == 0
                && let Some(codes) = codes
            {
                teacher.receive(&config, codes, 40);
            }
            match teacher.lesson(&config, Situation { grasp: true, disturbed }) {
                Ok(codes) => network.learn(&rule, &felt, &codes),
                // The first messages are not believed yet.
                Err(found) => assert!(found == reason || ms < 100 && found == NoLesson::Absent),
            }
            teacher.tick_ms();
        }
    };
    hour(None, false, NoLesson::Absent);
    hour(Some([Code::Zero; 2]), false, NoLesson::NothingMoves);
    hour(Some([Code::Minus, Code::Plus]), true, NoLesson::Disturbed);
    assert_eq!(network, before);
}

const NORMALISER: NormaliserConfig<RECEPTORS> = {
    let mut senses = [Sense::Pressure; RECEPTORS];
    let mut n = 0;
    while n < VIBRATION {
        senses[n] = Sense::Vibration;
        n += 1;
    }
    NormaliserConfig { senses, floors: [20; RECEPTORS], ceiling: 1 << 30, average_shift: 8 }
};

/// Everything together: raw readings of any gain, a camera that chatters and comes late, learning and using at once.
fn whole_path(finger: &Finger, config: &Config, average_shift: u32) -> Fate {
    let normalising = NormaliserConfig { average_shift, ..NORMALISER };
    let (rule, teacher_config) = (Rule::new(config).unwrap(), TeacherConfig::default());
    let mut normaliser = Normaliser::new(&normalising);
    let mut network = FingertipNetwork::default();
    let unloaded = std::array::from_fn(|j| if j == OFFSET { 0.8 } else { 0.0 });
    let unloaded = Activations::new(unloaded.map(Activation::from_f64));
    let raw = |felt: &Activations<RECEPTORS>| {
        let mut receptor = 0;
        felt.as_bits().map(|t| {
            receptor += 1;
            // Gains from 2^10 to 2^24 raw units.
            t >> (2 + receptor * 5 % 15)
        })
    };
    normaliser.zero(&raw(&unloaded));
    for seed in 0..7 {
        let mut teacher = Teacher::default();
        for (ms, moment) in finger.trial(seed).iter().enumerate() {
            if ms % 33 == 0 {
                // Every fifth picture sees no motion.
                let codes = if ms / 33 % 5 == 4 { [Code::Zero; 2] } else { moment.seen };
                teacher.receive(&teacher_config, codes, 66);
            }
            let raw = raw(&moment.felt);
            if let Ok(codes) = teacher.lesson(&teacher_config, Situation { grasp: true, disturbed: false }) {
                normaliser.observe(&normalising, &raw);
                network.learn(&rule, &normaliser.activations(&normalising, &raw), &codes);
            }
            teacher.tick_ms();
        }
    }
    let trial: Vec<_> = finger
        .trial(UNSEEN)
        .iter()
        .map(|moment| Moment { felt: normaliser.activations(&normalising, &raw(&moment.felt)), ..*moment })
        .collect();
    line("a finger", ask(&weights_of(&network), &trial));
    fate(&weights_of(&network), &trial)
}

#[test]
fn twenty_fingers_learn_with_the_same_rates() {
    let fates = |average_shift| {
        (0..20).map(move |seed| whole_path(&Finger::new(seed), &Config::default(), average_shift))
    };
    assert!(fates(NORMALISER.average_shift).all(|fate| fate == Fate::Useful));
    let single = fates(0).filter(|&fate| fate == Fate::Useful).count();
    println!("{single} of 20 fingers are useful with the maxima of single readings");
    assert_eq!(single, 19, "of 20 fingers");
}

/// Lessons without the lowering say 'up' twice as long as 'down': what feels the grasp takes part in the direction.
#[test]
fn lessons_that_say_up_more_than_down_spoil_the_direction() {
    let wrong = (0..20).filter(|&seed| {
        let finger = Finger::new(seed);
        let mut lesson = finger.lesson();
        lesson.retain(|m| m.seen != [Code::Plus, Code::Minus]);
        let weights = weights_of(&learned(&Config::default(), &lesson));
        ask(&weights, &finger.trial(UNSEEN)).direction < 0.99
    });
    let wrong = wrong.count();
    println!("{wrong} of 20 fingers tell the direction wrongly after lessons without lowering");
    assert_eq!(wrong, 6, "docs/hebbian.md says 6");
}
