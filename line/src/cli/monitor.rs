//! `tenax monitor`: a board's serial line, or one that was captured.

use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, bail};
use tenax_hal_shim::wire::{Answer, Down, SETTINGS_PER_ANSWER, Setting};
use tenax_logic::setting::SettingId;

use super::port;
use crate::monitor;
use crate::monitor::source::Places;
use crate::web::Web;
use tenax_frames::link::{ANSWER_WITHIN, Client, Target};
use tenax_frames::settings;
use tenax_frames::tool::out;
use tenax_frames::words::AnswerWords;

/// Watch a board's serial line.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Serial line: /dev/ttyACM0, COM3, /dev/pts/5, tcp:127.0.0.1:7777, or a file with a captured line [default: the only
    /// board that is plugged in]
    #[arg(long, value_name = "PORT")]
    port: Option<Target>,
    /// Play a recording (MCAP), or a captured line such as out/glass.line.bin of `tenax run`, instead of a board's line
    #[arg(long, value_name = "FILE", conflicts_with = "port")]
    file: Option<PathBuf>,
    /// Print one line a message instead of serving the page, as over SSH
    #[arg(long)]
    plain: bool,
    /// TCP port of 127.0.0.1 for the page; 0: any free port
    #[arg(long, value_name = "HTTP_PORT", default_value_t = 7780, conflicts_with = "plain")]
    web: u16,
    /// Also show the true forces and slip of a scene, from the address that `tenax run --serve-truth` prints. With --control,
    /// the page has the keys of the scene `bench`
    #[arg(long, value_name = "tcp:HOST:PORT", conflicts_with = "plain")]
    truth: Option<Target>,
    /// Let the page change settings, zero, calibration and the teacher [default: it only watches]
    #[arg(long, conflicts_with = "plain")]
    control: bool,
    /// Send this command and print the board's answer; may be given more than once. With --plain, watching goes on
    #[arg(long, value_name = "COMMAND")]
    send: Vec<Send>,
    /// Change a setting, such as s1-mv=120 (`tenax config list`: names, units, ranges); may be given more than once
    #[arg(long, value_name = "NAME=VALUE", value_parser = |text: &str| settings::parse(text))]
    set: Vec<Setting>,
    /// Print a setting's value; may be given more than once
    #[arg(long, value_name = "NAME", value_parser = |name: &str| settings::named(name))]
    get: Vec<SettingId>,
    /// Print every setting
    #[arg(long)]
    settings: bool,
    /// Send a camera's codes to the board, from standard input: a line `v1 v2 [age_ms]` for each picture, such as `-1 0 20`;
    /// codes are -1, 0 or 1
    #[arg(long)]
    teach: bool,
}

/// What can be sent by name.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Send {
    /// Ask whether the board answers
    Ping,
    /// Ask for the last sample of every channel
    Samples,
    /// Ask for the network's weights and activations
    Network,
    /// Take the force sensor's readings as zero; refused while the finger is loaded
    Zero,
    /// Save the network's weights now
    Save,
    /// Forget the network's weights
    Forget,
    /// Calibrate the myosensors to the wearer: three prompts of 5 s
    CalibrateEmg,
}

impl From<Send> for Down {
    fn from(send: Send) -> Self {
        match send {
            Send::Ping => Self::Ping,
            Send::Samples => Self::Samples,
            Send::Network => Self::Network,
            Send::Zero => Self::Zero,
            Send::Save => Self::Save,
            Send::Forget => Self::Forget,
            Send::CalibrateEmg => Self::CalibrateEmg,
        }
    }
}

/// Watches a line until it ends or the person does.
pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let target = match &args.file {
        Some(file) => Target::File(file.clone()),
        None => port::or_found(args.port.as_ref())?,
    };
    let places = Places { line: target.clone(), truth: args.truth.clone() };
    let told =
        !args.send.is_empty() || !args.set.is_empty() || !args.get.is_empty() || args.settings || args.teach;
    if !args.plain && !told {
        let web = Web::new(&places, args.control, args.web)?;
        out::note!("open {} in a browser of this machine; Ctrl-C ends it", web.place());
        web.serve();
        return Ok(ExitCode::SUCCESS);
    }
    let mut client = Client::open(&target)?;
    let refused = tell(args, &mut client)?;
    if told && !args.plain && !args.teach {
        return Ok(ExitCode::from(u8::from(refused)));
    }
    let end = match monitor::watch(&mut client, &mut io::stdout().lock()) {
        // Whoever read our output has read enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(ExitCode::SUCCESS),
        other => other.context("cannot print")?,
    };
    out::note!("{}", client.counts());
    match (end.kind(), &target) {
        (io::ErrorKind::UnexpectedEof, Target::File(_)) => Ok(ExitCode::SUCCESS),
        (io::ErrorKind::UnexpectedEof, _) => bail!(target.after_end(None)),
        _ => bail!(target.after_end(Some(&end))),
    }
}

/// Sends what is to be sent at once and prints the answers, and lets the teacher talk beside the watching. Whether
/// anything was refused.
fn tell(args: &Args, client: &mut Client) -> anyhow::Result<bool> {
    let set = args.set.iter().map(|&setting| Down::Set(setting));
    let get = args.get.iter().map(|&id| Down::Get(id.number()));
    // The first of each part of the table that one answer has room for.
    let all = SettingId::ALL.into_iter().step_by(SETTINGS_PER_ANSWER).map(|id| Down::Settings(id.number()));
    let all = all.filter(|_| args.settings);
    let mut refused = false;
    for command in args.send.iter().map(|&send| send.into()).chain(set).chain(get).chain(all) {
        let answer = client.ask(&command, ANSWER_WITHIN)?;
        refused |= matches!(answer, Answer::Refused(_));
        // Whoever goes on watching sees it where it comes up the line.
        if !args.plain && !args.teach {
            out::say!("{}", AnswerWords(&command, &answer))?;
        }
    }
    if args.teach {
        if !client.open_session(ANSWER_WITHIN)? {
            out::note!("tenax: the board opened no session; what changes something will be refused");
        }
        let Some(mut outbox) = client.take_outbox() else { return Ok(refused) };
        // It ends with its input, or with the process.
        std::thread::spawn(move || {
            if let Err(error) = outbox.teach(io::stdin().lock()) {
                out::note!("tenax: {error:#}; the teacher is not heard any more");
            }
        });
    }
    Ok(refused)
}
