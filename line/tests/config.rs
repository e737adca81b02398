//! `tenax config` against a served board: every setting is set, read back, exported, imported and reset.

use std::io::{Read, Write};
use std::thread;

use tenax_frames::link::Client;
use tenax_logic::setting::SettingId;

use crate::serving::{asked, busy, relay, tenax, trusting};

#[test]
fn every_setting_is_set_read_back_exported_imported_and_reset() {
    let served = trusting();
    let config = |args: &[&str]| tenax(&[&["config", "--port", &served.place], args].concat());
    let (_, list, _) = config(&["list"]);
    assert_eq!(list.matches(" = ").count(), SettingId::ALL.len(), "{list}");
    assert!(list.contains("; mV, 20 to 1500, default 100\ns1-mv = 100\n"), "{list}");

    // All but the one that makes the line trusted: without it all others would be refused.
    let settable: Vec<SettingId> =
        SettingId::ALL.into_iter().filter(|id| *id != SettingId::LineTrusted).collect();
    let wanted: Vec<String> =
        settable.iter().map(|id| format!("{}={}", id.row().name, id.row().min)).collect();
    let args: Vec<&str> = ["set"].into_iter().chain(wanted.iter().map(String::as_str)).collect();
    let (done, out, error) = config(&args);
    assert!(done && out.lines().count() == settable.len(), "{out}{error}");

    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("settings.toml");
    let file = file.to_str().unwrap();
    assert!(config(&["export", file]).0);
    assert!(std::fs::read_to_string(file).unwrap().contains("# Board: the host's own build.\n"));
    let (done, _, error) = config(&["reset"]);
    assert!(!done && error.contains("--all"), "nothing is reset unasked: {error}");
    assert!(config(&["reset", "--all"]).0);
    assert!(config(&["list"]).1.contains("line-trusted-flag = 1\n"), "trust is not reset");
    assert_eq!(config(&["get", "s1-mv"]).1, "100\n");
    assert!(config(&["import", file]).0);
    assert_eq!(config(&["get", "s1-mv"]).1, "20\n");
    let wrong = [
        ("s1 = 30", "no setting is called s1; the settings are s1-mv"),
        ("s1-mv = [", "no TOML"),
        ("s1-mv = 1.5", "s1-mv = 1.5 is no whole number"),
    ];
    for (text, words) in wrong {
        std::fs::write(file, text).unwrap();
        let (done, _, error) = config(&["import", file]);
        assert!(!done && error.contains(words), "{error}");
    }

    let (done, _, error) = config(&["set", "s1-mv=1501"]);
    assert!(!done && error.contains("s1-mv = 1501 is refused: it has to be 20 to 1500"), "{error}");
    // From here on consent is needed.
    assert!(config(&["set", "line-trusted-flag=0"]).0);
    let (done, _, error) = config(&["set", "s1-mv=120"]);
    assert!(!done && error.contains("nobody at the hand has consented"), "{error}");
    served.end();
}

#[test]
fn an_import_is_all_or_nothing_and_two_clients_get_their_own_answers() {
    let _busy = busy();
    let served = trusting();
    let config = |args: &[&str]| tenax(&[&["config", "--port", &served.place], args].concat());
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("settings.toml");
    // The last two are refused, for reasons of their own.
    std::fs::write(&file, "s2-permille = 250\ns1-mv = 5000\nsettle-ms = -7\n").unwrap();
    let (done, _, error) = config(&["import", file.to_str().unwrap()]);
    assert!(!done && error.contains("s1-mv = 5000 is refused: it has to be 20 to 1500"), "{error}");
    assert!(error.contains("settle-ms = -7 is refused") && error.contains("Nothing is changed"), "{error}");
    assert_eq!(config(&["get", "s2-permille"]).1, "300\n");
    // Its own export changes nothing, and is taken.
    assert!(config(&["export", file.to_str().unwrap()]).0);
    assert!(config(&["import", file.to_str().unwrap()]).0);

    let names = ["s1-mv", "s2-permille", "settle-ms", "motor-limit-ma"];
    let expected = names.map(|name| config(&["get", name]).1);
    assert!((0..4).all(|n| !expected[..n].contains(&expected[n])), "{expected:?}");
    thread::scope(|scope| {
        for (name, expected) in names.iter().zip(&expected) {
            let config = &config;
            scope.spawn(move || {
                (0..6).for_each(|_| assert_eq!(&config(&["get", name]).1, expected, "{name}"))
            });
        }
        // In one process, too: 10 000 requests with `TENAX_REQUESTS=2500`.
        for (name, expected) in names.iter().zip(&expected) {
            let (id, place) = (SettingId::by_name(name).unwrap(), &served.place);
            scope.spawn(move || {
                let mut client = Client::open(&place.parse().unwrap()).unwrap();
                for _ in 0..asked("TENAX_REQUESTS").unwrap_or(100) {
                    assert_eq!(format!("{}\n", client.setting(id).unwrap()), *expected, "{name}");
                }
            });
        }
    });
    served.end();
}

/// A line to the place that ends after so many commands.
fn ends_after(place: &str, commands: usize) -> String {
    relay(place, move |mut near, mut far| {
        let (mut byte, mut left) = ([0], commands);
        while left > 0 && near.read(&mut byte).unwrap_or(0) == 1 {
            far.write_all(&byte).unwrap();
            left -= usize::from(byte == [0]);
        }
        true
    })
}

#[test]
fn a_line_that_ends_within_an_import_leaves_all_settings_or_none() {
    let served = trusting();
    let wanted = ["s1-mv=120", "s2-permille=250", "settle-ms=70", "motor-limit-ma=900"];
    let list = || {
        let (done, list, error) = tenax(&["config", "--port", &served.place, "list"]);
        assert!(done, "{error}");
        list
    };
    let reset = || assert!(tenax(&["config", "--port", &served.place, "reset", "--all"]).0);
    reset();
    let before = list();
    let mut taken = Vec::new();
    for commands in 1..=16 {
        let port = ends_after(&served.place, commands);
        let (done, _, error) = tenax(&[&["config", "--port", &port, "set"][..], &wanted].concat());
        // What was on its way is there.
        thread::sleep(std::time::Duration::from_millis(100));
        let now = list();
        let set =
            wanted.iter().filter(|own| now.contains(&format!("\n{}\n", own.replace('=', " = ")))).count();
        assert!(
            set == 0 && now == before || set == wanted.len(),
            "{set} are set after {commands} commands: {error}"
        );
        let is_told = set == 0 || error.contains("all of them, or none") || error.contains("not read back");
        assert!(if done { set > 0 } else { is_told }, "{set} are set after {commands} commands: {error}");
        taken.push(set > 0);
        reset();
    }
    assert!(taken.is_sorted() && !taken[0] && taken[15], "{taken:?}");
    served.end();
}
