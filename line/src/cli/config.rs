//! `tenax config`: a board's settings.

use std::hash::{BuildHasher, RandomState};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::SystemTime;

use anyhow::{Context, bail, ensure};
use clap::Subcommand;
use tenax_hal_shim::wire::{Answer, Down, Refusal, SETTINGS_PER_ANSWER, Setting};
use tenax_logic::setting::SettingId;

use super::port::Line;
use tenax_frames::link::{ANSWER_WITHIN, Client};
use tenax_frames::settings;
use tenax_frames::tool::out;
use tenax_frames::words::refusal_words;

/// Transactions that are tried, if another client changes settings meanwhile or an answer is lost.
const ATTEMPTS: u32 = 3;

const EXAMPLES: &str = "\
Examples:
  tenax config list
  tenax config set s1-mv=120 s2-permille=300
  tenax config export hand.toml
  tenax config import hand.toml
  tenax config reset --all";

/// Show and change a board's settings.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    line: Line,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Print every setting: value, unit, range, default, meaning
    List,
    /// One setting's value
    Get {
        /// The setting, such as s1-mv
        #[arg(value_name = "NAME", value_parser = settings::named)]
        id: SettingId,
    },
    /// Change settings, all or none; each is read back
    Set {
        /// The settings and their values, such as s1-mv=120; the name's end is the unit
        #[arg(required = true, value_name = "NAME=VALUE", value_parser = settings::parse)]
        settings: Vec<Setting>,
    },
    /// Write every setting to a TOML file
    Export {
        /// The file, such as hand.toml [default: standard output]
        file: Option<PathBuf>,
    },
    /// Set all settings that a TOML file names, or none
    Import {
        /// A file that `tenax config export` wrote
        file: PathBuf,
    },
    /// Set settings back to their defaults
    Reset {
        /// Names of the settings, such as s1-mv s2-permille
        #[arg(value_name = "NAME", conflicts_with = "all", value_parser = settings::named)]
        ids: Vec<SettingId>,
        /// Reset every setting except line-trusted-flag
        #[arg(long)]
        all: bool,
    },
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let default = |id: SettingId| Setting { id: id.number(), value: id.row().default };
    // An error in a file is reported before the board is asked.
    let wanted: Vec<Setting> = match &args.command {
        Command::List | Command::Get { .. } | Command::Export { .. } => Vec::new(),
        Command::Set { settings } => settings.clone(),
        Command::Import { file } => {
            let text = std::fs::read_to_string(file);
            let text = text.with_context(|| format!("cannot read {}", file.display()))?;
            settings::of_toml(&text).with_context(|| file.display().to_string())?
        }
        Command::Reset { all: true, .. } => {
            SettingId::ALL.into_iter().filter(|id| *id != SettingId::LineTrusted).map(default).collect()
        }
        Command::Reset { ids, .. } if ids.is_empty() => {
            bail!("name the settings to reset, or give --all; `tenax config list` shows value and default")
        }
        Command::Reset { ids, .. } => ids.iter().copied().map(default).collect(),
    };
    let mut client = args.line.open()?;
    match &args.command {
        Command::List => out::print(format_args!("{}", settings::toml(&all(&mut client)?)))?,
        Command::Get { id } => out::say!("{}", client.setting(*id)?)?,
        Command::Export { file } => {
            let text = match client.ask(&Down::About, ANSWER_WITHIN)? {
                Answer::About(about) => settings::backup(&about, &all(&mut client)?, SystemTime::now()),
                other => bail!("the board answers {other:?}"),
            };
            match file {
                None => out::print(format_args!("{text}"))?,
                Some(file) => {
                    std::fs::write(file, text).with_context(|| format!("cannot write {}", file.display()))?;
                }
            }
        }
        Command::Set { .. } | Command::Import { .. } | Command::Reset { .. } => {
            set(&mut client, &wanted)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Every setting of the board.
fn all(client: &mut Client) -> anyhow::Result<Vec<Setting>> {
    let mut settings: Vec<Setting> = Vec::new();
    loop {
        let from = settings.last().map_or(0, |last| last.id + 1);
        let answer = client.ask(&Down::Settings(from), ANSWER_WITHIN)?;
        let Answer::Settings(some) = answer else { bail!("the board answers {answer:?}") };
        settings.extend(&some);
        if some.len() < SETTINGS_PER_ANSWER || settings.last().is_none_or(|last| last.id == u8::MAX) {
            return Ok(settings);
        }
    }
}

/// Sets all, or none, and reads them back. Fails with what was refused, and why.
pub fn set(client: &mut Client, wanted: &[Setting]) -> anyhow::Result<()> {
    let before = all(client)?;
    let changes: Vec<Setting> = wanted.iter().filter(|own| !before.contains(own)).copied().collect();
    let other = |now: &[Setting]| wanted.iter().find(|own| !now.contains(own)).map(words);
    for attempts_left in (0..ATTEMPTS).rev() {
        let why = match transact(client, &changes) {
            Ok(refused) if refused.is_empty() => break,
            Ok(refused) if refused.iter().all(|(_, why)| *why == Refusal::Incomplete) => {
                "settings are changed by another client at the same time".to_owned()
            }
            Ok(refused) => {
                let told = refused
                    .iter()
                    .map(|(own, why)| format!("{} is refused: {}", words(own), refusal_words(why)));
                bail!("{}. Nothing is changed", told.collect::<Vec<_>>().join("; "))
            }
            Err(error) => format!("{error:#}"),
        };
        let now = all(client).with_context(|| format!("{why}. The board has set all of them, or none"))?;
        if other(&now).is_none() {
            break;
        }
        ensure!(attempts_left > 0, "{why}. Nothing is changed");
    }
    let other = other(&all(client).context("set, and not read back")?);
    ensure!(other.is_none(), "{} was set, and is not what the board now says", other.unwrap_or_default());
    wanted.iter().try_for_each(|own| out::say!("{}", words(own)))
}

/// One transaction. Returns what was refused: then the board has changed nothing.
fn transact(client: &mut Client, changes: &[Setting]) -> anyhow::Result<Vec<(Setting, Refusal)>> {
    // Another client's transaction has another mark.
    let of = RandomState::new().hash_one(()) as u16;
    let count = changes.len() as u8;
    let mut refused = Vec::new();
    for (n, &setting) in (0..).zip(changes) {
        match client.ask(&Down::SetOf { of, n, count, setting }, ANSWER_WITHIN)? {
            Answer::Done => {}
            // It is named already.
            Answer::Refused(Refusal::Incomplete) if !refused.is_empty() => {}
            Answer::Refused(why) => {
                refused.push((setting, why));
                if !matches!(why, Refusal::OutOfRange { .. } | Refusal::UnknownSetting) {
                    break;
                }
            }
            other => bail!("the board answers {other:?}"),
        }
    }
    Ok(refused)
}

fn words(setting: &Setting) -> String {
    let name = SettingId::from_number(setting.id).map_or("?", |id| id.row().name);
    format!("{name} = {}", setting.value)
}
