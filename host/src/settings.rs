//! The settings as a page for people: `docs/settings.md`. A test holds that file against this.

use std::fmt::Write;

use anyhow::{Context, bail};
use tenax_hal_shim::setting::SettingId;
use tenax_hal_shim::wire::Setting;

const HEAD: &str = "\
# Settings

Printed from `hal-shim/src/setting.rs` by `cargo tenax settings`; do not edit.

`cargo tenax monitor --port P --set NAME=VALUE` changes one, `--get NAME` and `--settings` show what is in force; a scene
file uses `kind = \"set-NAME\"` with `value`. Refused are a value out of range, with the range, and a change that nobody at
the hand consents to (`docs/safety.md`). No pair of values in the ranges crushes, opens or deafens
(`host-tests/tests/ranges.rs`); the wider ones are a laboratory's. Changed settings outlive a power cut. The number is what
the wire and the flash call the setting.

| number | name | unit | range | default | meaning |
|---|---|---|---|---|---|
";

/// The whole page.
#[must_use]
pub fn markdown() -> String {
    let mut page = String::from(HEAD);
    for id in SettingId::ALL {
        let row = id.row();
        let (number, range) = (id as u8, row.range());
        // Writing into a String cannot fail.
        let _ = writeln!(
            page,
            "| {number} | `{}` | {} | {} to {}{} | {} | {} |",
            row.name,
            row.unit,
            range.start(),
            range.end(),
            if row.max_if_trusted > row.max {
                format!(" ({} where the line is trusted)", row.max_if_trusted)
            } else {
                String::new()
            },
            row.default,
            row.meaning
        );
    }
    page
}

/// The setting of this name.
///
/// # Errors
/// Names all that there are.
pub fn named(name: &str) -> anyhow::Result<SettingId> {
    SettingId::by_name(name).with_context(|| {
        let names = SettingId::ALL.map(|id| id.row().name).join(", ");
        format!("no setting is called {name}; the settings are {names}")
    })
}

/// Settings as a TOML file, with what each does.
#[must_use]
pub fn toml(settings: &[Setting]) -> String {
    let mut text =
        String::from("# Settings of a Tenax board. `tenax config import` sets what is named here.\n");
    for setting in settings {
        if let Some(id) = SettingId::from_number(setting.id) {
            let row = id.row();
            // Writing into a String cannot fail.
            let _ = writeln!(
                text,
                "\n# {}; {}, {} to {}, default {}\n{} = {}",
                row.meaning, row.unit, row.min, row.max, row.default, row.name, setting.value
            );
        }
    }
    text
}

/// The settings that a TOML file names. Whether the line is trusted comes last: a narrower range is in force after it.
///
/// # Errors
/// Says what is wrong with it.
pub fn of_toml(text: &str) -> anyhow::Result<Vec<Setting>> {
    let table: toml::Table = text.parse().context("this is no TOML")?;
    let mut settings: Vec<Setting> =
        table.iter().map(|(name, value)| parse(&format!("{name}={value}"))).collect::<anyhow::Result<_>>()?;
    settings.sort_by_key(|setting| setting.id == SettingId::LineTrusted as u8);
    Ok(settings)
}

/// A setting and its value from `NAME=VALUE`.
///
/// # Errors
/// Says what is wrong with it, and which values are accepted.
pub fn parse(text: &str) -> anyhow::Result<Setting> {
    let (name, value) = text.split_once('=').with_context(|| format!("{text} is no NAME=VALUE"))?;
    let id = named(name.trim())?;
    let row = id.row();
    let value: i32 = value.trim().parse().with_context(|| format!("{value} is no whole number"))?;
    // The board knows whether it trusts the line, and says so.
    if !row.range_if_trusted().contains(&value) {
        bail!("{} = {value} {} is outside {} to {}", row.name, row.unit, row.min, row.max_if_trusted);
    }
    Ok(Setting { id: id as u8, value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exported_file_is_imported_as_it_was() {
        let all = SettingId::ALL.map(|id| Setting { id: id as u8, value: id.row().min });
        let mut back = of_toml(&toml(&all)).unwrap();
        back.sort_by_key(|setting| setting.id);
        assert_eq!(back, all);
        for (wrong, word) in [("s1-mv = 5", "20 to"), ("s1 = 1", "no setting"), ("s1-mv = [", "no TOML")] {
            let error = format!("{:#}", of_toml(wrong).unwrap_err());
            assert!(error.contains(word), "{error}");
        }
    }

    #[test]
    fn a_setting_is_read_by_either_name_and_a_wrong_one_says_what_is_right() {
        let set = Setting { id: SettingId::EmgOn as u8, value: 200 };
        assert_eq!(parse("emg-on-mv=200").unwrap(), set);
        assert_eq!(parse("myo-on-mv = 200").unwrap(), set);
        for (text, word) in [
            ("emg-on-mv", "NAME=VALUE"),
            ("emg=1", "emg-on-mv"),
            ("emg-on-mv=1", "80 to 400"),
            ("emg-on-mv=x", "whole"),
        ] {
            let wrong = format!("{:#}", parse(text).unwrap_err());
            assert!(wrong.contains(word), "{wrong}");
        }
    }
}
