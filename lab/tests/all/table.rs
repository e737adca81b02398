//! `tenax chart table`: its keys, its intervals, and detectors whose figures are known before they are heard. Seeds are in the plans.

use serde_json::Value;
use tenax_lab::chart::table::costs::Costs;
use tenax_lab::chart::table::heard::{Felt, Judge, Kind, Plan};
use tenax_lab::chart::table::scored::Scored;
use tenax_lab::chart::table::{Options, table};

const fn plan(seed: u64) -> Plan {
    Plan { seed, fingers: 1, pours: 1, picks: 0, minutes: 1 }
}

#[test]
fn every_row_has_the_keys_and_the_same_slips_and_its_intervals_bracket() {
    let options = Options { plans: [plan(1), plan(2), plan(3)] };
    println!("{options:?}");
    let table = table(&options, &Costs::default(), &|_| {}).unwrap();
    println!("{table}");
    let chart = table.chart().unwrap();
    assert_eq!(chart.csv.lines().count(), 1 + table.rows.len());
    let Value::Array(rows) = serde_json::to_value(&table).unwrap()["rows"].take() else { panic!("no rows") };
    let keys = "name data instructions_mean instructions_max cycles_mean flash_bytes ram_bytes latency_ms_p50 latency_ms_p95 lead_ms_p50 \
                recall_1mm recall_1mm_low recall_1mm_high false_per_hour_quiet false_per_hour_disturbed";
    let slips = rows[0]["slips_1mm"].clone();
    assert!(slips.as_u64().is_some_and(|slips| slips > 5), "{slips}");
    for row in &rows {
        let has = |key: &&str| row.get(*key).is_some();
        assert!(keys.split_whitespace().all(|key| has(&key)), "{row}");
        // Nothing was counted, so nothing is told.
        assert!(
            row["instructions_mean"].is_null() && row["cycles_mean"].is_null() && row["ram_bytes"].is_null()
        );
        let number = |key: &str| row[key].as_f64().unwrap();
        assert!(
            number("recall_1mm_low") <= number("recall_1mm")
                && number("recall_1mm") <= number("recall_1mm_high"),
            "{row}"
        );
        assert!(number("recall_1mm_low") < number("recall_1mm_high"), "{row}");
        for kind in ["quiet", "disturbed"] {
            let [value, low, high] = ["value", "low", "high"].map(|key| row[kind][key].as_f64().unwrap());
            assert!(low <= value && value < high, "{row}");
        }
        assert_eq!(row["slips_1mm"], slips);
        let is_caught = number("recall_1mm") > 0.0;
        assert_eq!(row["latency_ms_p50"].is_number(), is_caught, "{row}");
    }
    let recall = |name: &str| {
        let row = rows.iter().find(|row| row["name"] == name).expect(name);
        row["recall_1mm"].as_f64().unwrap()
    };
    // Whoever adds a detector misses no slip more.
    assert!(recall("s1 or mlp") >= recall("s1").max(recall("mlp")));
    assert!(recall("the hand: any of four") >= recall("s1 or hebbian"));
}

/// Never says slip, always, or anew in every other frame.
struct Known(fn(u32) -> bool);

impl Judge for Known {
    fn hear(&mut self, felt: &Felt<'_>) -> bool {
        self.0(felt.frame.sequence)
    }
}

#[test]
fn one_that_is_deaf_and_ones_that_never_stop_have_the_figures_that_they_must() {
    let plan = plan(4);
    println!("{plan:?}");
    let rows = || -> Vec<Box<dyn Judge>> {
        let all: [fn(u32) -> bool; 3] = [|_| false, |_| true, |frame| frame.is_multiple_of(2)];
        all.map(|known| -> Box<dyn Judge> { Box::new(Known(known)) }).into()
    };
    let heard = plan.fingertip(0, false).unwrap().record(&plan, &rows, &mut |_, _| (), &mut || ()).unwrap();
    let [deaf, stands, shouts] = [0, 1, 2].map(|row| Scored::of(&heard, row..row + 1));
    assert!(deaf.count(1.0) > 0);
    let recall = |scored: &Scored| scored.recall(1.0).unwrap().value;
    assert_eq!([&deaf, &stands, &shouts].map(recall), [0.0, 0.0, 1.0]);
    assert_eq!(stands.stood_before(1.0), Some(1.0));
    for kind in [Kind::Quiet, Kind::Disturbed] {
        let per_hour = |scored: &Scored| scored.false_per_hour(kind).unwrap().value;
        // What stands has begun before the minute is scored; of what shouts, one in 50 ms is counted.
        assert_eq!([&deaf, &stands].map(per_hour), [0.0, 0.0]);
        assert!((per_hour(&shouts) / (20.0 * 3_600.0) - 1.0).abs() < 0.05, "{}", per_hour(&shouts));
    }
    assert_eq!((deaf.latency_ms(0.5), deaf.lead_ms()), (None, None));
    assert!(shouts.lead_ms().is_some());
}
