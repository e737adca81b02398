//! Settings by name, and as a TOML file.

use std::fmt::Write;
use std::time::SystemTime;

use anyhow::Context;
use tenax_hal_shim::wire::{About, Setting, VERSION};
use tenax_logic::setting::SettingId;

use crate::words::identity_words;

/// The setting of this name. An error names all that there are.
pub fn named(name: &str) -> anyhow::Result<SettingId> {
    SettingId::by_name(name).with_context(|| {
        let names = SettingId::ALL.map(|id| id.row().name).join(", ");
        format!("no setting is called {name}; the settings are {names}")
    })
}

/// Whether the line is trusted with these settings: it decides the ranges of some.
pub fn trusts_line(settings: &[Setting]) -> bool {
    settings.contains(&Setting { id: SettingId::LineTrusted.number(), value: 1 })
}

/// Hash (FNV-1a) of the settings' numbers, names and units, to notice a file of another tool.
pub fn schema() -> u32 {
    let rows = SettingId::ALL.map(|id| format!("{} {} {}\n", id.number(), id.row().name, id.row().unit));
    rows.concat().bytes().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

/// The words before [`schema`] in a file.
const SCHEMA: &str = "# Schema of the settings: ";

/// A board's settings as a TOML file that names the board.
pub fn backup(about: &About, settings: &[Setting]) -> String {
    let now = humantime::format_rfc3339_seconds(SystemTime::now());
    format!(
        "# Saved {now} by tenax {}, wire version {VERSION}, schema {:016x}.\n# Board: {}.\n{SCHEMA}{:08x}\n{}",
        env!("CARGO_PKG_VERSION"),
        about.schema,
        identity_words(about),
        schema(),
        toml(settings)
    )
}

/// A warning, if a backup was saved by a tool that has other settings.
pub fn of_other_schema(text: &str) -> Option<String> {
    let own = format!("{:08x}", schema());
    let other = text.lines().find_map(|line| line.strip_prefix(SCHEMA)).filter(|other| *other != own)?;
    Some(format!(
        "was saved with other settings (schema {other}; this tool has {own}): look through what is set"
    ))
}

/// Settings as a TOML file, with unit, range and meaning of each.
pub fn toml(settings: &[Setting]) -> String {
    let mut text = String::from("# `tenax config import` sets what is named here.\n");
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

/// The settings that a TOML file names. `line-trusted-flag` comes last: after it narrower ranges can be in force.
/// An error says what is wrong with the text.
pub fn of_toml(text: &str) -> anyhow::Result<Vec<Setting>> {
    let table: toml::Table = text.parse().context("this is no TOML")?;
    let mut settings: Vec<Setting> =
        table.iter().map(|(name, value)| parse(&format!("{name}={value}"))).collect::<anyhow::Result<_>>()?;
    settings.sort_by_key(|setting| setting.id == SettingId::LineTrusted.number());
    Ok(settings)
}

/// A setting and its value from `NAME=VALUE`; the board checks the range. An error says what is wrong with the text.
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
    fn a_backup_names_its_board_and_is_imported_as_it_was() {
        let all = SettingId::ALL.map(|id| Setting { id: id.number(), value: id.row().min });
        let text = backup(&About { schema: 0x1234, ..About::default() }, &all);
        for word in
            ["the host's own build", "schema 0000000000001234", &format!("settings: {:08x}", schema())]
        {
            assert!(text.contains(word), "{text}");
        }
        assert_eq!(of_other_schema(&text), None);
        let mut back = of_toml(&text).unwrap();
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
