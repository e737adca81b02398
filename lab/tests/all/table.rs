//! `tenax chart table`: its keys, its intervals. Seeds are in the plans.

use serde_json::Value;
use tenax_lab::chart::table::heard::Plan;
use tenax_lab::chart::table::table;

const fn plan(seed: u64) -> Plan {
    Plan { seed, fingers: 1, pours: 1, picks: 0, minutes: 1 }
}

#[test]
fn every_row_has_the_keys_and_the_same_slips_and_its_intervals_bracket() {
    let table = table(&[plan(1), plan(2), plan(3)], &|_| {}).unwrap();
    assert!(table.slips_1mm > 5, "{}", table.slips_1mm);
    let Value::Array(rows) = serde_json::to_value(&table).unwrap()["rows"].take() else { panic!("no rows") };
    let keys = "name recall_1mm latency_ms_p50 latency_ms_p95 quiet disturbed between_slips";
    for row in &rows {
        let has = |key: &str| row.get(key).is_some();
        assert!(keys.split_whitespace().all(has), "{row}");
        let between = |key: &str| [0, 1, 2].map(|n| row[key][n].as_f64().unwrap());
        for key in ["recall_1mm", "quiet", "disturbed", "between_slips"] {
            let [value, low, high] = between(key);
            assert!(low <= value && value <= high && low < high, "{row}");
        }
        let is_caught = between("recall_1mm")[0] > 0.0;
        assert_eq!(row["latency_ms_p50"].is_number(), is_caught, "{row}");
    }
    let recall = |name: &str| {
        let row = rows.iter().find(|row| row["name"] == name).expect(name);
        row["recall_1mm"][0].as_f64().unwrap()
    };
    // Whoever adds a detector misses no slip more.
    assert!(recall("s1 or mlp") >= recall("s1").max(recall("mlp")));
    assert!(recall("the hand: any of four") >= recall("s1 or hebbian"));
}
