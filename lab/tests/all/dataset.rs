//! `tenax dataset`: the same bytes for the same seed, no session in two splits, labels that are the world's.

use std::collections::{BTreeMap, BTreeSet};

use tenax_lab::dataset::material::{HELD_OUT, SEEN};
use tenax_lab::dataset::session::{Part, Sizes, sessions};
use tenax_lab::dataset::story::Story;
use tenax_lab::dataset::{Dataset, Plan, collect};

const SMALL: Plan = Plan { seed: 3, sessions: 1 };

#[test]
fn a_small_one_is_what_its_manifest_says() {
    let dataset = Dataset::make(SMALL, None, &|_| {}).unwrap();
    let csv = dataset.csv().unwrap();
    let manifest = dataset.manifest("small.csv", &csv);
    let text = toml::to_string(&manifest).unwrap();
    assert!(text.contains(&manifest.sha256) && text.contains("held_out = \"rubber\""));

    let header = b"split,session,material,recording,task,t_s,label,slips,a1,a2,a3,a4,a5,a6,a7,a8,a9,a10\n";
    assert!(csv.starts_with(header));
    let rows: Vec<_> = csv::Reader::from_reader(csv.as_slice()).records().map(|row| row.unwrap()).collect();
    let steps: usize = manifest.split.values().map(|counts| counts.steps).sum();
    assert_eq!(rows.len(), steps);

    // No session in two splits, and none of the held-out material but in the test.
    let mut splits: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for row in &rows {
        splits.entry(&row[1]).or_default().insert(&row[0]);
        assert!(&row[2] != HELD_OUT.name || &row[0] == "test");
    }
    assert!(splits.values().all(|splits| splits.len() == 1), "{splits:?}");
    assert_eq!(splits.len(), 4 * 3 + 2);

    // Every split has slip and its absence; what disturbs is never slip; every sample has 14 bits.
    for split in ["train", "validation", "test"] {
        let slips = rows.iter().filter(|row| &row[0] == split && &row[6] == "1").count();
        let all = rows.iter().filter(|row| &row[0] == split).count();
        assert!(slips > all / 50 && slips < all / 2, "{slips} of {all} in {split}");
    }
    assert!(rows.iter().filter(|row| row[3].ends_with("-disturb")).all(|row| &row[6] == "0"));
    assert!(
        rows.iter().flat_map(|row| row.iter().skip(8)).all(|sample| sample.parse::<u16>().unwrap() <= 16_380)
    );
}

#[test]
fn the_same_seed_gives_the_same_recording_and_another_gives_another() {
    let of_seed = |seed| collect::record(&sessions(seed, Sizes::of_train(1))[0], Story::Pick).unwrap();
    assert_eq!(of_seed(5), of_seed(5));
    assert_ne!(of_seed(5), of_seed(6));
}

#[test]
fn a_larger_one_has_every_session_of_a_smaller_one_in_the_same_split() {
    let [few, more] = [1, Sizes::DEFAULT_TRAIN].map(|train| sessions(1, Sizes::of_train(train)));
    assert_eq!(few.len(), SEEN.len() * 3 + 2);
    // So a network that learned from the larger one has not seen the test of the smaller one.
    assert!(few.iter().all(|session| more.contains(session)));
    let names: BTreeSet<&str> = more.iter().map(|session| session.name.as_str()).collect();
    let seeds: BTreeSet<u64> = more.iter().map(|session| session.seed).collect();
    assert_eq!((names.len(), seeds.len()), (more.len(), more.len()));
    // A pour is 26 s of 80 steps; the paper validates on 2800.
    let tested = more.iter().filter(|session| session.split == Part::Test).count();
    assert!(tested * 26 * 80 > 2_800, "{tested} sessions");
}
