//! `tenax monitor --web`: what the screen shows, as one page in a browser of this machine.
//!
//! The page is one file without a build step, and comes from the tool. Points come as server-sent events, twenty times a
//! second; plain HTTP/1.1 is enough for both, so there is no crate for it. Only this machine is served, and only pages of
//! this address may ask: a page of somebody else's in the same browser may not.

mod json;
mod wizard;

use std::io::{self, BufRead, BufReader, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use anyhow::Context;
use tenax_hal_shim::wire::{Down, Setting};
use tenax_logic::setting::SettingId;

use self::json::After;
use self::wizard::Wizard;
use crate::monitor::source::{self, Places};
use crate::monitor::view::View;
use tenax_frames::settings;

const PAGE: &str = include_str!("web/page.html");
const EVENT_EVERY: Duration = Duration::from_millis(50);
/// A request's head is no longer than this.
const HEAD_MAX: usize = 8 << 10;
/// What is done at the bench is said in no more bytes.
const ACT_MAX: usize = 40;

/// What is known, and the test that goes on.
#[derive(Default)]
struct Seen {
    view: View,
    wizard: Wizard,
}

/// What every connection works with.
#[derive(Clone)]
struct Shared {
    seen: Arc<Mutex<Seen>>,
    commands: Sender<Down>,
    /// What is done at the bench of a scene. No command of the board's line is among it.
    bench: Sender<String>,
    place: String,
    control: bool,
    port: u16,
}

pub struct Web {
    listener: TcpListener,
    shared: Shared,
}

impl Web {
    /// Watches a board, for a page on this port of 127.0.0.1; 0: any that is free. Fails if the port cannot be had.
    pub fn new(places: &Places, control: bool, port: u16) -> anyhow::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).with_context(|| {
            format!("cannot serve a page on port {port}: choose another, or 0 for any that is free")
        })?;
        let port = listener.local_addr()?.port();
        let (commands, waiting) = channel();
        let (sender, news) = channel();
        let seen = Arc::<Mutex<Seen>>::default();
        let bench = source::start(places, waiting, sender);
        let taken = Arc::clone(&seen);
        thread::spawn(move || {
            for news in news {
                let mut seen = taken.lock().unwrap_or_else(PoisonError::into_inner);
                seen.wizard.take(&news);
                seen.view.take(news);
            }
        });
        Ok(Self {
            listener,
            shared: Shared { seen, commands, bench, place: places.line.to_string(), control, port },
        })
    }

    /// Where the page is.
    pub fn place(&self) -> String {
        format!("http://127.0.0.1:{}/", self.shared.port)
    }

    /// Serves whoever comes, for ever.
    pub fn serve(&self) {
        for stream in self.listener.incoming().flatten() {
            let shared = self.shared.clone();
            thread::spawn(move || {
                // Whoever leaves in the middle is gone.
                let _left = answer(&stream, &shared);
            });
        }
    }
}

/// A request: its method and path, and whether a page of ours may have sent it.
struct Request {
    method: String,
    path: String,
    is_ours: bool,
}

fn request(stream: &TcpStream, port: u16) -> io::Result<Option<Request>> {
    stream.set_read_timeout(Some(Duration::from_secs(5)))?;
    let mut lines = BufReader::new(io::Read::take(stream, HEAD_MAX as u64)).lines();
    let Some(first) = lines.next().transpose()? else { return Ok(None) };
    let mut words = first.split(' ');
    let (method, path) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
    let (mut host_is_ours, mut origin_is_ours) = (false, true);
    for line in lines {
        let line = line?;
        if line.is_empty() {
            break;
        }
        let Some((name, value)) = line.split_once(':') else { continue };
        let ours = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
        match name.to_ascii_lowercase().as_str() {
            "host" => host_is_ours = ours.contains(&value.trim().to_owned()),
            "origin" => {
                origin_is_ours =
                    value.trim().strip_prefix("http://").is_some_and(|own| ours.contains(&own.to_owned()));
            }
            _ => {}
        }
    }
    Ok(Some(Request {
        method: method.to_owned(),
        path: path.to_owned(),
        is_ours: host_is_ours && origin_is_ours,
    }))
}

fn answer(stream: &TcpStream, shared: &Shared) -> io::Result<()> {
    let Some(request) = request(stream, shared.port)? else { return Ok(()) };
    if !request.is_ours {
        return reply(stream, "403 Forbidden", "text/plain", "only pages of this address may ask");
    }
    match (request.method.as_str(), request.path.as_str()) {
        ("GET", "/") => reply(stream, "200 OK", "text/html; charset=utf-8", PAGE),
        ("GET", "/settings") => {
            let text = json::settings(&shared.seen().view, shared.control).to_string();
            reply(stream, "200 OK", "application/json", &text)
        }
        ("GET", "/settings.toml") => match backup(&shared.seen().view) {
            Some(text) => reply(stream, "200 OK", "application/toml", &text),
            None => reply(stream, "404 Not Found", "text/plain", "the board has not said who it is"),
        },
        ("GET", "/events") => events(stream, shared),
        ("POST", path) => {
            let (status, text) = told(path, shared);
            reply(stream, status, "text/plain", &text)
        }
        _ => reply(stream, "404 Not Found", "text/plain", "there is no such page"),
    }
}

impl Shared {
    fn seen(&self) -> MutexGuard<'_, Seen> {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Does what the page asks for, if that is allowed: the answer's status and text.
fn told(path: &str, shared: &Shared) -> (&'static str, String) {
    let answer = |status, text: &str| (status, text.to_owned());
    if let Some(words) = path.strip_prefix("/selftest/") {
        let words: Vec<String> = words.split('/').map(str::to_owned).collect();
        let Seen { view, wizard } = &mut *shared.seen();
        return match wizard.command(view, &words) {
            Ok(()) => answer("202 Accepted", "done"),
            Err(why) => ("409 Conflict", format!("{why:#}")),
        };
    }
    if let Some(control) = words(path, "/play/") {
        return match shared.bench.send(control) {
            Ok(()) => answer("202 Accepted", "done"),
            Err(_) => answer("404 Not Found", "this is no recording"),
        };
    }
    let act = words(path, "/bench/");
    let command = command(path);
    if act.is_none() && command.is_none() {
        return answer("404 Not Found", "no such command");
    }
    if !shared.control {
        return answer("403 Forbidden", "read only: start with --control to change anything");
    }
    let sent = match (act, command) {
        (Some(act), _) => {
            let view = &mut shared.seen().view;
            if view.bench.is_none() {
                return answer("404 Not Found", "no bench: only a served scene has one, where --truth says");
            }
            view.say(format!("at the bench: {act}"));
            shared.bench.send(act).is_ok()
        }
        (None, command) => command.is_some_and(|command| shared.commands.send(command).is_ok()),
    };
    if sent { answer("202 Accepted", "sent") } else { answer("503 Service Unavailable", "there is no line") }
}

/// The settings as a file, as soon as the board has said who it is.
fn backup(view: &View) -> Option<String> {
    let settings: Vec<Setting> = view.settings.iter().map(|(&id, &value)| Setting { id, value }).collect();
    view.about.as_ref().map(|about| settings::backup(about, &settings))
}

/// The line for the bench, or for what plays a recording, that a path stands for: `/bench/tap/pvdf_3`, `/play/+5`.
fn words(path: &str, stem: &str) -> Option<String> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || "_./+-".contains(c);
    let act = path.strip_prefix(stem).filter(|act| act.len() <= ACT_MAX && act.chars().all(is_word))?;
    Some(act.replace('/', " "))
}

/// The command that a path stands for.
fn command(path: &str) -> Option<Down> {
    match path {
        "/zero" => Some(Down::Zero),
        "/calibrate" => Some(Down::CalibrateEmg),
        _ => {
            let (name, value) = path.strip_prefix("/set/")?.split_once('/')?;
            let id = SettingId::by_name(name)?;
            Some(Down::Set(Setting { id: id.number(), value: value.parse().ok()? }))
        }
    }
}

fn reply(mut stream: &TcpStream, status: &str, kind: &str, body: &str) -> io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nX-Content-Type-Options: nosniff\r\n\
         Connection: close\r\n\r\n{body}",
        body.len()
    )
}

/// What is new, for as long as the page is open.
fn events(mut stream: &TcpStream, shared: &Shared) -> io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n"
    )?;
    let mut after = After::NOTHING;
    loop {
        let text = {
            let seen = shared.seen();
            let all = After::all(&seen);
            if all.points_s < after.points_s {
                after.points_s = f64::MIN;
            }
            if all.truth_s < after.truth_s {
                after.truth_s = f64::MIN;
            }
            let event = json::event(&seen, &shared.place, &after);
            after = all;
            event.to_string()
        };
        write!(stream, "data: {text}\n\n")?;
        thread::sleep(EVENT_EVERY);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_a_command_or_none() {
        let set = Down::Set(Setting { id: SettingId::S1.number(), value: 120 });
        assert_eq!(command("/set/s1-mv/120"), Some(set));
        assert_eq!(command("/zero"), Some(Down::Zero));
        let act = |path| words(path, "/bench/");
        assert_eq!(act("/bench/tap/pvdf_3").as_deref(), Some("tap pvdf_3"));
        assert_eq!((act("/bench/g%0ao"), act("/zero"), command("/bench/g")), (None, None, None));
        assert_eq!(words("/play/+5", "/play/").as_deref(), Some("+5"));
        for wrong in ["/", "/set/s1-mv", "/set/s1/120", "/set/s1-mv/x", "/drive"] {
            assert_eq!(command(wrong), None, "{wrong}");
        }
    }
}
