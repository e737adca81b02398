//! `tenax config`: a board's settings.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::Subcommand;
use tenax_hal_shim::wire::{Answer, Down, SETTINGS_PER_ANSWER, Setting};
use tenax_logic::setting::SettingId;

use super::port::Line;
use tenax_frames::link::{ANSWER_WITHIN, Client};
use tenax_frames::settings;
use tenax_frames::tool::out;
use tenax_frames::words::refusal_words;

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
    /// Change settings; each is read back
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
    /// Set all settings that a TOML file names
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
                Answer::About(about) => settings::backup(&about, &all(&mut client)?),
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
            wanted.into_iter().try_for_each(|setting| set(&mut client, setting))?;
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

/// Sets a setting and reads it back.
pub fn set(client: &mut Client, setting: Setting) -> anyhow::Result<()> {
    let name = SettingId::from_number(setting.id).map_or("?", |id| id.row().name);
    match client.ask(&Down::Set(setting), ANSWER_WITHIN)? {
        Answer::Setting(own) if own == setting => {}
        Answer::Refused(why) => bail!("{name} = {} is refused: {}", setting.value, refusal_words(&why)),
        other => bail!("the board answers {other:?}"),
    }
    match client.ask(&Down::Get(setting.id), ANSWER_WITHIN)? {
        Answer::Setting(own) if own == setting => out::say!("{name} = {}", own.value),
        other => bail!("{name} was set to {}, and the board now answers {other:?}", setting.value),
    }
}
