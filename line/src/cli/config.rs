//! `tenax config`: a board's settings.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::Subcommand;
use tenax_hal_shim::wire::{Answer, Down, Refusal, SETTINGS_PER_ANSWER, Setting};
use tenax_logic::setting::SettingId;

use super::port;
use tenax_frames::link::{ANSWER_WITHIN, Client, Target};
use tenax_frames::settings;
use tenax_frames::tool::out;

/// Show and change a board's settings.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Serial line: /dev/ttyACM0, COM3, /dev/pts/5 or tcp:127.0.0.1:7777 [default: the only board that is plugged in]
    #[arg(long, value_name = "PORT", global = true)]
    port: Option<Target>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Every setting: value, unit, range, default, meaning
    List,
    /// One setting's value
    Get {
        /// The setting, such as s1-mv
        name: String,
    },
    /// Change settings; each is read back
    Set {
        /// The settings and their values, such as s1-mv=120; the name's end is the unit
        #[arg(required = true, value_name = "NAME=VALUE", value_parser = |text: &str| settings::parse(text))]
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
    /// Settings that differ from their defaults, or from a file
    Diff {
        /// A file that `tenax config export` wrote [default: the defaults]
        file: Option<PathBuf>,
    },
    /// Set settings back to their defaults
    Reset {
        /// Names of the settings, such as s1-mv s2-permille
        #[arg(conflicts_with = "all")]
        names: Vec<String>,
        /// Reset every setting except line-trusted-flag
        #[arg(long)]
        all: bool,
    },
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    // What is wrong with a file or a name is said before the board is asked.
    let wanted = wanted(&args.command)?;
    let mut client = Client::open(&port::or_found(args.port.as_ref())?)?;
    match &args.command {
        Command::List => out::print(format_args!("{}", list(&all(&mut client)?)))?,
        Command::Get { name } => out::say!("{}", client.setting(settings::named(name)?)?)?,
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
        Command::Diff { .. } => {
            let own = all(&mut client)?;
            for Setting { id, value } in wanted {
                let name = SettingId::from_number(id).map_or("?", |id| id.row().name);
                match own.iter().find(|setting| setting.id == id) {
                    Some(own) if own.value == value => {}
                    Some(own) => out::say!("{name} = {}, there {value}", own.value)?,
                    None => out::say!("{name}: the board does not have it, there {value}")?,
                }
            }
        }
        Command::Set { .. } | Command::Import { .. } | Command::Reset { .. } => {
            for setting in &wanted {
                set(&mut client, *setting)?;
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// What is to be set.
fn wanted(command: &Command) -> anyhow::Result<Vec<Setting>> {
    let default = |id: SettingId| Setting { id: id.number(), value: id.row().default };
    match command {
        Command::List | Command::Export { .. } => Ok(Vec::new()),
        Command::Get { name } => settings::named(name).map(|_| Vec::new()),
        Command::Set { settings } => Ok(settings.clone()),
        Command::Diff { file: None } => Ok(SettingId::ALL.into_iter().map(default).collect()),
        Command::Import { file } | Command::Diff { file: Some(file) } => of_file(file),
        Command::Reset { all: true, .. } => {
            Ok(SettingId::ALL.into_iter().filter(|id| *id != SettingId::LineTrusted).map(default).collect())
        }
        Command::Reset { names, .. } if names.is_empty() => {
            bail!("name the settings to reset, or give --all; `tenax config diff` shows which differ")
        }
        Command::Reset { names, .. } => names.iter().map(|name| settings::named(name).map(default)).collect(),
    }
}

/// The settings that a file names. Says so if it is of a tool that has others. Fails if it cannot be read, or names what there is not.
pub fn of_file(path: &Path) -> anyhow::Result<Vec<Setting>> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    if let Some(why) = settings::of_other_schema(&text) {
        out::note!("{} {why}", path.display());
    }
    settings::of_toml(&text).with_context(|| path.display().to_string())
}

/// Every setting of the board.
fn all(client: &mut Client) -> anyhow::Result<Vec<Setting>> {
    let mut settings: Vec<Setting> = Vec::new();
    let mut from = 0;
    loop {
        let answer = client.ask(&Down::Settings(from), ANSWER_WITHIN)?;
        let Answer::Settings(some) = answer else { bail!("the board answers {answer:?}") };
        settings.extend(&some);
        match some.last() {
            Some(last) if some.len() == SETTINGS_PER_ANSWER && last.id < u8::MAX => from = last.id + 1,
            _ => return Ok(settings),
        }
    }
}

/// Sets a setting, and says so. Fails if the board does not have it then.
pub fn set(client: &mut Client, setting: Setting) -> anyhow::Result<()> {
    let name = SettingId::from_number(setting.id).map_or("?", |id| id.row().name);
    match client.ask(&Down::Set(setting), ANSWER_WITHIN)? {
        Answer::Setting(own) if own == setting => {}
        Answer::Setting(own) => bail!("{name}: the board says {} instead of {}", own.value, setting.value),
        Answer::Refused(Refusal::OutOfRange { min, max }) => {
            bail!("{name} = {} is refused: it has to be {min} to {max}", setting.value)
        }
        Answer::Refused(Refusal::NotArmed) => bail!(
            "{name} is refused: nobody at the hand has consented. Contract both muscles for 2 s or press the blue button \
             (of a served scene: Enter where it runs), then try again within a minute"
        ),
        Answer::Refused(why) => bail!("{name} = {} is refused: {why:?}", setting.value),
        other => bail!("the board answers {other:?}"),
    }
    // What it answers is what it has; what it has is asked for once more.
    match client.ask(&Down::Get(setting.id), ANSWER_WITHIN)? {
        Answer::Setting(own) if own == setting => {
            out::say!("{name} = {}", own.value)
        }
        other => bail!("{name} was set to {}, and the board now answers {other:?}", setting.value),
    }
}

fn list(settings: &[Setting]) -> String {
    let line = |setting: &Setting| match SettingId::from_number(setting.id) {
        Some(id) => {
            let row = id.row();
            let (min, max) = row.range().into_inner();
            let changed = if setting.value == row.default { ' ' } else { '*' };
            format!(
                "{changed} {:<28}{:>9} {:<10} {min} to {max}, default {}: {}\n",
                row.name, setting.value, row.unit, row.default, row.meaning
            )
        }
        None => format!("? setting {} = {}, which this tool does not know\n", setting.id, setting.value),
    };
    settings.iter().map(line).collect()
}
