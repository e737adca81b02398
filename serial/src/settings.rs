//! The settings as a page for people: `docs/settings.md`. A test holds that file against this.

use std::fmt::Write;

use anyhow::Context;
use tenax_hal_shim::wire::Setting;
use tenax_logic::setting::SettingId;

const HEAD: &str = "\
# Settings

This page lists the numbers that a user can change.

<!-- Printed from logic/src/*/settings.rs by cargo tenax settings; do not edit. -->

Press the blue button shortly ([consent](safety.md#the-cable)), then run `cargo tenax config set NAME=VALUE`. The value outlives a power cut. A scene uses
`kind = \"set-NAME\"` with `value`. A trusted line has wider ranges. Within the others, no two settings together open the hand or switch slip detection off. The number
is the setting's name on wire and in flash.

| number | name with unit | range | default | meaning |
|---|---|---|---|---|
";

/// The whole page.
pub fn markdown() -> String {
    let mut page = String::from(HEAD);
    for id in SettingId::ALL {
        let row = id.row();
        let (number, range) = (id.number(), row.range());
        // Writing into a String cannot fail.
        let _ = writeln!(
            page,
            "| {number} | `{}` | {} to {}{} | {} | {} |",
            row.name,
            range.start(),
            range.end(),
            match row.range_in_force(true) {
                trusted if trusted == range => String::new(),
                trusted => format!(" (trusted: {} to {})", trusted.start(), trusted.end()),
            },
            row.default,
            row.meaning
        );
    }
    page
}

/// The setting of this name. An error names all that there are.
pub fn named(name: &str) -> anyhow::Result<SettingId> {
    SettingId::by_name(name).with_context(|| {
        let names = SettingId::ALL.map(|id| id.row().name).join(", ");
        format!("no setting is called {name}; the settings are {names}")
    })
}

/// Whether the line is trusted where these are in force: it decides how far some of them may go.
pub fn trusts_line(settings: &[Setting]) -> bool {
    settings.contains(&Setting { id: SettingId::LineTrusted.number(), value: 1 })
}

/// Settings as a TOML file, with what each does.
pub fn toml(settings: &[Setting]) -> String {
    let mut text =
        String::from("# Settings of a Tenax board. `tenax config import` sets what is named here.\n");
    let trusted = trusts_line(settings);
    for setting in settings {
        if let Some(id) = SettingId::from_number(setting.id) {
            let row = id.row();
            let (min, max) = row.range_in_force(trusted).into_inner();
            // Writing into a String cannot fail.
            let _ = writeln!(
                text,
                "\n# {}; {}, {min} to {max}, default {}\n{} = {}",
                row.meaning, row.unit, row.default, row.name, setting.value
            );
        }
    }
    text
}

/// The settings that a TOML file names. Whether the line is trusted comes last: a narrower range is in force after it.
/// An error says what is wrong with it.
pub fn of_toml(text: &str) -> anyhow::Result<Vec<Setting>> {
    let table: toml::Table = text.parse().context("this is no TOML")?;
    let mut settings: Vec<Setting> =
        table.iter().map(|(name, value)| parse(&format!("{name}={value}"))).collect::<anyhow::Result<_>>()?;
    settings.sort_by_key(|setting| setting.id == SettingId::LineTrusted.number());
    Ok(settings)
}

/// A setting and its value from `NAME=VALUE`. Whether the value is accepted is for the board to say, which knows the range that is
/// in force. An error says what is wrong with it.
pub fn parse(text: &str) -> anyhow::Result<Setting> {
    let (name, value) = text.split_once('=').with_context(|| format!("{text} is no NAME=VALUE"))?;
    let id = named(name.trim())?;
    let value: i32 = value.trim().parse().with_context(|| format!("{value} is no whole number"))?;
    Ok(Setting { id: id.number(), value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exported_file_is_imported_as_it_was() {
        let all = SettingId::ALL.map(|id| Setting { id: id.number(), value: id.row().min });
        let mut back = of_toml(&toml(&all)).unwrap();
        back.sort_by_key(|setting| setting.id);
        assert_eq!(back, all);
        for (wrong, word) in [("s1 = 1", "no setting"), ("s1-mv = [", "no TOML")] {
            let error = format!("{:#}", of_toml(wrong).unwrap_err());
            assert!(error.contains(word), "{error}");
        }
    }

    #[test]
    fn a_setting_is_read_by_either_name_and_a_wrong_one_says_what_is_right() {
        let set = Setting { id: SettingId::EmgOn.number(), value: 200 };
        assert_eq!(parse("emg-on-mv=200").unwrap(), set);
        assert_eq!(parse("myo-on-mv = 200").unwrap(), set);
        for (text, word) in [("emg-on-mv", "NAME=VALUE"), ("emg=1", "emg-on-mv"), ("emg-on-mv=x", "whole")] {
            let wrong = format!("{:#}", parse(text).unwrap_err());
            assert!(wrong.contains(word), "{wrong}");
        }
    }
}
