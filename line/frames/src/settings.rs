//! Settings by name, and as a TOML file.

use std::fmt::Write;
use std::time::SystemTime;

use anyhow::Context;
use tenax_hal_shim::wire::{About, Setting, VERSION};
use tenax_logic::setting::SettingId;

use crate::words::identity_words;

pub fn named(name: &str) -> anyhow::Result<SettingId> {
    SettingId::by_name(name).with_context(|| {
        let names = SettingId::ALL.map(|id| id.row().name).join(", ");
        format!("no setting is called {name}; the settings are {names}")
    })
}

pub fn backup(about: &About, settings: &[Setting], now: SystemTime) -> String {
    let now = humantime::format_rfc3339_seconds(now);
    format!(
        "# Saved {now} by tenax {}, wire version {VERSION}, schema {:016x}.\n# Board: {}.\n{}",
        env!("CARGO_PKG_VERSION"),
        about.schema,
        identity_words(about),
        toml(settings)
    )
}

/// Settings as a TOML file, with unit, range and meaning of each.
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

/// The settings that a TOML file names. `line-trusted-flag` comes last: without trust, what follows would need consent.
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
    let value: i32 = value.trim().parse().with_context(|| format!("{name} = {value} is no whole number"))?;
    Ok(Setting { id: id.number(), value })
}
