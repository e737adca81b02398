//! `tenax config` against a served board: every setting is set, read back, exported, imported and reset.

use tenax_logic::setting::SettingId;

use crate::serving::Serving;
use crate::tool::tenax;

fn config(place: &str, args: &[&str]) -> (bool, String, String) {
    tenax(&[&["config", "--port", place], args].concat())
}

#[test]
fn every_setting_is_set_read_back_exported_imported_and_reset() {
    let served = Serving::trusting();
    let place = served.places[0].as_str();

    let (_, list, _) = config(place, &["list"]);
    assert_eq!(list.lines().count(), SettingId::ALL.len(), "{list}");
    assert!(list.contains("s1-mv") && list.contains("20 to 1500, default 100: S1"), "{list}");

    // All but the one that makes the line trusted: without it everything else would be refused.
    let settable: Vec<SettingId> =
        SettingId::ALL.into_iter().filter(|id| *id != SettingId::LineTrusted).collect();
    let wanted: Vec<String> =
        settable.iter().map(|id| format!("{}={}", id.row().name, id.row().min)).collect();
    let args: Vec<&str> = ["set"].into_iter().chain(wanted.iter().map(String::as_str)).collect();
    let (done, out, error) = config(place, &args);
    assert!(done && out.lines().count() == settable.len(), "{out}{error}");

    let file = served.folder.path().join("settings.toml");
    let file = file.to_str().unwrap();
    assert!(config(place, &["export", file]).0);
    let (done, _, error) = config(place, &["reset"]);
    assert!(!done && error.contains("--all"), "nothing is reset unasked: {error}");
    let (_, differs, _) = config(place, &["diff"]);
    assert!(differs.contains("s1-mv = 30, there 100\n"), "{differs}");
    assert!(config(place, &["reset", "--all"]).0);
    assert_eq!(config(place, &["diff"]).1, "line-trusted-flag = 1, there 0\n");
    assert!(config(place, &["diff", file]).1.contains("s1-mv = 100, there 30\n"));
    assert_eq!(config(place, &["get", "s1-mv"]).1, "100\n");
    assert!(std::fs::read_to_string(file).unwrap().contains("\ns1-mv = 30\n"));
    let (_, exported, _) = config(place, &["export"]);
    for known in
        ["# Saved 20", ", wire version ", "# Board: the host's own build.", "# Schema of the settings: "]
    {
        assert!(exported.contains(known), "{exported}");
    }
    // A file from a tool that has other settings is read, and says so.
    std::fs::write(file, exported.replacen("settings: ", "settings: 1", 1)).unwrap();
    let (done, _, error) = config(place, &["diff", file]);
    assert!(done && error.contains("was saved with other settings"), "{error}");
    assert!(exported.contains("\ns1-mv = 100\n"), "{exported}");

    let (done, _, error) = config(place, &["set", "s1-mv=1501"]);
    assert!(!done && error.contains("s1-mv = 1501 is refused: it has to be 20 to 1500"), "{error}");
    // From here on the narrower range is in force, and somebody has to be at the hand.
    assert!(config(place, &["set", "line-trusted-flag=0"]).0);
    let (done, _, error) = config(place, &["set", "s1-mv=120"]);
    assert!(!done && error.contains("nobody at the hand has consented"), "{error}");
    let (done, _, error) = config(place, &["get", "s1"]);
    assert!(!done && error.contains("no setting is called s1; the settings are s1-mv"), "{error}");
    served.end();
}
