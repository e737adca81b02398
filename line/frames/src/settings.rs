//! The settings as a page for people: `docs/settings.md`. A test holds that file against this.

use std::fmt::Write;

use std::collections::BTreeMap;
use std::time::SystemTime;

use anyhow::Context;
use serde::Serialize;
use tenax_hal_shim::wire::{About, Setting, VERSION};
use tenax_logic::setting::SettingId;

use crate::words::AboutWords;

const HEAD: &str = "\
# Settings

This page lists the numbers that a user can change.

<!-- Printed from logic/src/*/settings.rs by cargo tenax settings; do not edit. -->

Press the blue button briefly ([consent](safety.md#the-cable)), then run `cargo tenax config set NAME=VALUE`. The value outlives a power cut. A scene uses
`kind = \"set-NAME\"` with `value`. No setting opens the hand or closes it above the force ceiling; some can switch slip detection off.
The number names the setting on the wire and in flash.

| number | name with unit | range | default | meaning |
|---|---|---|---|---|
";

pub fn markdown() -> String {
    let mut page = String::from(HEAD);
    for id in SettingId::ALL {
        let row = id.row();
        let (number, range) = (id.number(), row.range());
        // Writing into a String cannot fail.
        let _ = writeln!(
            page,
            "| {number} | `{}` | {} to {} | {} | {} |",
            row.name,
            range.start(),
            range.end(),
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

/// The trace of a screen or page that shows what a setting moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Trace {
    Vibration,
    Ratio,
    Load,
    Muscles,
}

impl Trace {
    /// None: no trace shows it.
    pub fn of(id: SettingId) -> Option<Self> {
        let name = id.row().name;
        let is = |stems: &[&str]| stems.iter().any(|stem| name.starts_with(stem));
        if is(&["s1-", "impact-"]) {
            Some(Self::Vibration)
        } else if is(&["s2-", "loaded-", "hebbian-ahead"]) {
            Some(Self::Ratio)
        } else if is(&["force-ceiling", "slip-", "incipient-", "settle-", "blind-"]) {
            Some(Self::Load)
        } else if is(&["emg-"]) {
            Some(Self::Muscles)
        } else {
            None
        }
    }
}

/// Which settings there are, and in which units (FNV-1a): a file from other ones says so.
pub fn schema() -> u32 {
    let rows = SettingId::ALL.map(|id| format!("{} {} {}\n", id.number(), id.row().name, id.row().unit));
    rows.concat().bytes().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

/// What stands before [`schema`] in a file.
const SCHEMA: &str = "# Schema of the settings: ";

/// A board's settings as a TOML file that says whose they are.
pub fn backup(about: &About, settings: &[Setting]) -> String {
    let now = humantime::format_rfc3339_seconds(SystemTime::now());
    format!(
        "# Saved {now} by tenax {}, wire version {VERSION}, schema {:016x}.\n# Board: {}.\n{SCHEMA}{:08x}\n{}",
        env!("CARGO_PKG_VERSION"),
        about.schema,
        AboutWords(about),
        schema(),
        toml(settings)
    )
}

/// Of the text of a backup: what there is to say of it if it was saved by a tool that has other settings.
pub fn of_other_schema(text: &str) -> Option<String> {
    let (own, other) =
        (format!("{:08x}", schema()), text.lines().find_map(|line| line.strip_prefix(SCHEMA))?);
    (own != other).then(|| {
        format!(
            "was saved with other settings (schema {other}; this tool has {own}): look through what is set"
        )
    })
}

/// Those of a list by their numbers.
pub fn by_number(settings: &[Setting]) -> BTreeMap<u8, i32> {
    settings.iter().map(|setting| (setting.id, setting.value)).collect()
}

/// Settings as a TOML file, with what each does.
pub fn toml(settings: &[Setting]) -> String {
    let mut text = String::from("# `tenax config import` sets what is named here.\n");
    for setting in settings {
        if let Some(id) = SettingId::from_number(setting.id) {
            let row = id.row();
            let (min, max) = row.range().into_inner();
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

/// The settings that a TOML file names. Whether the line is trusted comes last: without trust, what follows would need consent.
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
    fn a_backup_names_its_board_and_what_moves_a_trace_is_known() {
        let about =
            About { identity: Default::default(), schema: 0x1234, frames: 0, settings: Default::default() };
        let text = backup(&about, &[Setting { id: SettingId::S1.number(), value: 120 }]);
        for word in
            ["the host's own build", "schema 0000000000001234", &format!("settings: {:08x}", schema())]
        {
            assert!(text.contains(word), "{text}");
        }
        assert_eq!(by_number(&of_toml(&text).unwrap())[&SettingId::S1.number()], 120);
        assert_eq!(
            [SettingId::S1, SettingId::S2].map(Trace::of),
            [Some(Trace::Vibration), Some(Trace::Ratio)]
        );
        assert_eq!(Trace::of(SettingId::LineTrusted), None);
    }

    #[test]
    fn a_setting_is_read_and_a_wrong_one_says_what_is_right() {
        let set = Setting { id: SettingId::EmgOn.number(), value: 200 };
        assert_eq!(parse("emg-on-mv=200").unwrap(), set);
        assert_eq!(parse("emg-on-mv = 200").unwrap(), set);
        for (text, word) in [("emg-on-mv", "NAME=VALUE"), ("emg=1", "emg-on-mv"), ("emg-on-mv=x", "whole")] {
            let wrong = format!("{:#}", parse(text).unwrap_err());
            assert!(wrong.contains(word), "{wrong}");
        }
    }
}
