//! A recording with a mistake gets one message that names the file, the row and what is allowed.

use crate::common::with_head;
use tenax_sim::input::Table;
use tenax_sim::replay::recipe::Time;
use tenax_sim::replay::{Recipe, Recording};

fn message(csv: &str) -> String {
    let recording = Recording::parse(csv.as_bytes(), "r.csv");
    match recording.and_then(|recording| recording.series("a").map(|_| ())) {
        Ok(()) => panic!("accepted: {csv:?}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn mistakes_are_named_by_file_and_row() {
    for (csv, expected) in [
        ("", "r.csv: 0 rows of samples; a recording has a header line and at least two rows"),
        ("t,a\n", "r.csv: 0 rows"),
        ("t,a\n0,1\n", "r.csv: 1 rows"),
        ("time,a\n0,1\n1,1\n", "r.csv:1: no time column: one must be called `t` or `t_s`"),
        ("t,b\n0,1\n1,1\n", "r.csv:1: no column `a`; the columns are `t`, `b`"),
        ("t,a,a\n0,1,1\n1,1,1\n", "r.csv:1: two columns are called `a`"),
        ("t,a\n0,1\n1,one\n", "r.csv:3: column `a` is `one`, which is not a number"),
        ("t,a\n0,1\n1,\n", "r.csv:3: column `a` is ``, which is not a number"),
        ("t,a\n0,1\n1,NaN\n", "r.csv:3: column `a` is `NaN`; only finite numbers are allowed"),
        ("t,a\n0,1\n1,inf\n", "r.csv:3: column `a` is `inf`; only finite numbers"),
        ("t,a\n0,1\nNaN,1\n", "r.csv:3: column `t` is `NaN`"),
        ("t,a\n0,1\n2,1\n1,1\n", "r.csv:4: time goes backwards, from 2 s to 1 s"),
        ("t,a\n1,1\n1,2\n", "r.csv: every row has the time 1 s; a recipe can say the rows a second"),
        ("t,a\n0,1\n1,1,1\n", "r.csv:3: 3 cells, but the header has 2"),
        ("# a comment\nt,a\n0,1\n1,x\n", "r.csv:4: column `a` is `x`"),
        (
            "t,a\n0,1\n5500,1\n",
            "r.csv: lasts 5500 s and 600 s is the longest allowed; is its time in seconds?",
        ),
    ] {
        let message = message(csv);
        assert!(message.starts_with(expected), "{csv:?}\nsays      {message}\ninstead of {expected}");
    }
}

#[test]
fn a_recipe_names_the_clock_and_its_unit() {
    let map = "[[map]]\ncolumn = 'a'\nchannels = ['pvdf_1']\ngain = 1.0\n";
    let recipe = |time: &str| Recipe::parse(&with_head(&format!("[time]\n{time}\n{map}")), "r.toml");
    let read = |csv: &str, time: &str| {
        Recording::timed(csv.as_bytes(), "r.csv", &Table::default(), &recipe(time).unwrap().time)
    };
    let csv = "stamp,a,t\n1500,1,7\n1600,2,7\n";
    for (unit, first_s) in [("s", 1_500.0), ("ms", 1.5), ("us", 0.001_5)] {
        let recording = read(csv, &format!("column = 'stamp'\nunit = '{unit}'")).unwrap();
        assert_eq!((recording.first_s(), recording.signals().collect::<Vec<_>>()), (first_s, vec!["a", "t"]));
    }
    let error = read(csv, "column = 'when'").unwrap_err().to_string();
    let expected = "r.csv:1: no time column `when`, which the recipe names; the columns are `stamp`";
    assert!(error.starts_with(expected), "{error}");
    let error = read("t,a\n0,1\n5500,1\n", "unit = 's'").unwrap_err().to_string();
    assert!(error.contains("[time] unit = \"ms\""), "{error}");
    let error = recipe("unit = 'h'").unwrap_err().to_string();
    assert!(
        error.starts_with("r.toml:4: unknown variant `h`, expected one of `s`, `ms`, `us`, `ns`"),
        "{error}"
    );
}

#[test]
fn what_is_not_text_is_refused_by_row_and_a_missing_file_is_named() {
    let error = Recording::parse(&b"t,a\n0,1\n1,\xff\xfe\n"[..], "r.csv").unwrap_err().to_string();
    assert!(error.starts_with("r.csv:3: not text"), "{error}");
    let error = Recording::read("no/such/file.csv".as_ref(), &Table::default(), &Time::default())
        .unwrap_err()
        .to_string();
    assert!(error.starts_with("no/such/file.csv: cannot be read"), "{error}");
}

#[test]
fn uneven_rows_columns_of_words_and_a_byte_order_mark_are_fine() {
    let csv = "\u{feff}t_s, a ,label\n0.0,1.5,rest\n0.001,2.5,rest\n0.001,3.5,grasp\n0.1,4.5,grasp\n";
    let recording = Recording::parse(csv.as_bytes(), "r.csv").unwrap();
    assert_eq!(recording.series("a").unwrap(), [1.5, 2.5, 3.5, 4.5]);
    assert_eq!(recording.signals().collect::<Vec<_>>(), ["a", "label"]);
    assert!((recording.longest_gap_s() - 0.099).abs() < 1e-12);
    assert!((recording.rate_hz() - 30.0).abs() < 1e-9);
}

/// What public recorders' files looked like: the recipe's layout, the text, and a column with its times and values.
#[test]
fn anybodys_table_is_read_as_its_recipe_says() {
    let map = "[[map]]\ncolumn = 'a'\nchannels = ['pvdf_1']\ngain = 1.0\n";
    for (layout, csv, name, times, values) in [
        ("[table]\ncomment = '%'\n", "t,a\n0,1\n% paused\n2,3\n", "a", [0.0, 2.0], [1.0, 3.0]),
        ("[table]\ndelimiter = \"\\t\"\n", "t\ta\n0\t1\n2\t3\n", "a", [0.0, 2.0], [1.0, 3.0]),
        ("[table]\ndelimiter = ';'\ndecimal = ','\n", "t;a\n0,5;1,65\n2;-3\n", "a", [0.5, 2.0], [1.65, -3.0]),
        (
            "[table]\ndelimiter = ';'\ndecimal = ','\nheader = false\n[time]\nrate_hz = 2\n",
            "7;1,65\n7;3\n",
            "column_2",
            [0.0, 0.5],
            [1.65, 3.0],
        ),
    ] {
        let recipe = Recipe::parse(&with_head(&format!("{layout}{map}")), "r.toml").unwrap();
        let read = Recording::timed(csv.as_bytes(), "r.csv", &recipe.table(), &recipe.time).unwrap();
        assert_eq!((read.t_s(), read.series(name).unwrap()), (&times[..], values.to_vec()), "{layout}");
    }
    let wrong = |layout: &str| {
        Recipe::parse(&with_head(&format!("{layout}\n{map}")), "r.toml").unwrap_err().to_string()
    };
    let twice = wrong("[table]\ndelimiter = ','\ndecimal = ','");
    assert!(twice.starts_with("r.toml:3: delimiter, decimal"), "{twice}");
    let both = wrong("[time]\ncolumn = 't'\nrate_hz = 5");
    assert!(both.starts_with("r.toml:5: give either rate_hz or column"), "{both}");
    assert!(wrong("[table]\nseparator = ','").contains("unknown field `separator`"));
}

#[test]
fn a_table_that_is_written_otherwise_is_told_so() {
    for (csv, expected) in [
        ("t\ta\n0\t1\n1\t2\n", "a recipe says: [table] delimiter = \"\\t\""),
        ("t;a\n0,1;1\n1,1;2\n", "a recipe says: [table] delimiter = \";\""),
        ("0,1.5\n0.1,1.6\n", "a recipe says: [table] header = false"),
        ("t,a\n0,\"1,5\"\n1,\"1,6\"\n", "a recipe says: [table] decimal = \",\""),
    ] {
        assert!(message(csv).contains(expected), "{csv:?} says {}", message(csv));
    }
}

/// Sixteen samples that arrive together, as over Bluetooth: after a pause, a burst is no longer than others.
#[test]
fn bursts_with_one_stamp_are_spread_evenly_beside_a_pause() {
    let rows: String = (0..160)
        .map(|n| format!("{},{n}\n", f64::from(n / 16 * 16 + 15 + if n < 80 { 0 } else { 1_000 }) / 1e3))
        .collect();
    let paused = Recording::parse(format!("t,a\n{rows}").as_bytes(), "r.csv").unwrap();
    assert!((paused.t_s()[80] - 1.080).abs() < 1e-9 && (paused.longest_gap_s() - 1.001).abs() < 1e-9);
    assert!(
        paused.doubts()[0].starts_with("150 rows have the time of the row before"),
        "{:?}",
        paused.doubts()
    );
}
