//! Training is deterministic, learns what can be learned, and gives the firmware what it was trained with.

use std::path::Path;

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use tenax_lab::train::features::{Recipe, Sequence, sequence};
use tenax_lab::train::fit::{Candidate, FEW_OBJECTS, Trained, fit, judge};
use tenax_lab::train::quantise::Quantised;
use tenax_lab::train::score::{Aim, Judged, score};
use tenax_lab::train::table::Table;
use tenax_logic::array::{ELEMENTS, Preprocessor, PreprocessorConfig};
use tenax_sim::labelled::{self, Recording, Step, library};

/// Objects that tremble more while they slip, each with noise of its own.
fn trembling(seed: u64) -> Vec<Recording> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..12)
        .map(|n| {
            let mut level = [4_000.0; ELEMENTS];
            let steps = (0..160)
                .map(|step| {
                    let slip = step % 80 >= 40;
                    let size = if slip { 60.0 } else { 8.0 };
                    for level in &mut level {
                        *level += size * (rng.random::<f64>() - 0.5);
                    }
                    Step { samples: level.map(|level| level as u16), slip }
                })
                .collect();
            let session = format!("object {}", n % 4);
            let made = Recording::of_steps(&n.to_string(), steps);
            Recording { material: session.clone(), session, ..made }
        })
        .collect()
}

fn sequences(recordings: &[Recording], recipe: &Recipe) -> Vec<Sequence> {
    recordings.iter().map(|recording| sequence(recording, recipe)).collect()
}

const QUICK: Candidate = Candidate { epochs: 3, learning_rate: 2e-3, ..FEW_OBJECTS[1] };

#[test]
fn features_are_the_firmwares_bit_for_bit() {
    for recipe in [Recipe::FIRMWARE, Recipe { lag: 5, ..Recipe::FIRMWARE }] {
        for recording in trembling(1) {
            let config = PreprocessorConfig {
                lag: recipe.lag as u8,
                covariance_knee: recipe.covariance_knee,
                spectrum_knee: recipe.spectrum_knee,
                structure_knee: recipe.structure_knee,
                ..PreprocessorConfig::DEFAULT
            };
            let mut firmware = <Preprocessor>::new(config);
            let steps = recording.steps.iter();
            let expected: Vec<_> =
                steps.filter_map(|step| firmware.push(&step.samples.map(Some)).copied()).collect();
            assert_eq!(sequence(&recording, &recipe).features, expected);
        }
    }
}

#[test]
fn what_can_be_learned_is_learned_and_rounding_costs_little() {
    let sequences = sequences(&trembling(1), &Recipe::FIRMWARE);
    let trained: Trained = fit(&sequences, &[QUICK], Aim::Balanced, 1, &mut |_| {}).unwrap();
    // A window of ten remembers a slip for a while: half of it, twice in eighty steps, is the best that can be.
    assert!(trained.choice.unseen > 0.85, "{:?}", trained.choice);
    let table = Table::of(&sequences);
    let float = score(&judge(&trained.network, &table), trained.choice.threshold);
    let quantised = Quantised::of(&trained.network, &table);
    let mut judged = Judged::default();
    for sequence in &sequences {
        judged.slips.extend(&sequence.slips);
        judged.logits.extend(quantised.logits(sequence).unwrap());
    }
    let rounded = score(&judged, trained.choice.threshold);
    assert_eq!(rounded.steps, float.steps);
    assert!((rounded.accuracy - float.accuracy).abs() < 0.01, "{float:?} {rounded:?}");
}

#[test]
fn the_same_seed_gives_the_same_weights_and_another_gives_others() {
    let sequences = sequences(&trembling(1), &Recipe::FIRMWARE);
    let network = |seed| {
        let cold = Candidate { warm: false, ..QUICK };
        fit(&sequences, &[cold], Aim::Balanced, seed, &mut |_| {}).unwrap().network
    };
    assert_eq!(network(3), network(3));
    assert_ne!(network(3), network(4));
}

#[test]
fn too_little_to_choose_by_is_said() {
    let (mut one, mut quiet) = (trembling(1), trembling(1));
    one.iter_mut().for_each(|recording| recording.session = "cup".into());
    quiet.iter_mut().flat_map(|recording| &mut recording.steps).for_each(|step| step.slip = false);
    for (recordings, said) in [(one, "at least two are needed"), (quiet, "both kinds are needed")] {
        let sequences = sequences(&recordings, &Recipe::FIRMWARE);
        let error = fit(&sequences, &[QUICK], Aim::Balanced, 1, &mut |_| {}).unwrap_err();
        assert!(error.to_string().contains(said), "{error}");
    }
}

/// Learned from four real objects, scored on two others: the bar of the project is 0.90 a step.
#[test]
#[cfg_attr(not(recordings), ignore = "no recordings in ../shared/data")]
fn real_objects_that_were_never_seen() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let files = ["array_biotac_sp_basic.csv", "array_biotac_sp_solids.csv"].map(|file| folder.join(file));
    let read = library::choose(&files[0], None).unwrap();
    let recipe =
        Recipe { lag: 20, window: 40, covariance_knee: 6_400, spectrum_knee: 25_600, ..Recipe::FIRMWARE };
    let [basic, solids] = files.map(|file| sequences(&labelled::read(&file, &read).unwrap(), &recipe));
    // No passes: the logistic regression that the network begins as, which is what four objects leave it at.
    let candidate = Candidate { epochs: 0, ..FEW_OBJECTS[0] };
    let trained = fit(&basic, &[candidate], Aim::Balanced, 1, &mut |_| {}).unwrap();
    let scored = score(&judge(&trained.network, &Table::of(&solids)), trained.choice.threshold);
    println!("{:?}\n{scored:?}", trained.choice);
    assert!(scored.balanced >= 0.90 && scored.auc >= 0.95, "{scored:?}");
}
