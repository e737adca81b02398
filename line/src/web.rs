//! The page of `tenax monitor`, in a browser of this machine.
//!
//! Changes come as server-sent events, at most twenty a second. Only this machine is served, and only pages of this address may ask: a page
//! of another site in the same browser may not.

pub mod source;
pub mod view;

use std::io::{self, Write};
use std::iter;
use std::net::Ipv4Addr;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use anyhow::anyhow;
use serde_json::{Value, json};
use tenax_frames::link::Target;
use tenax_hal_shim::wire::{Down, Setting};
use tenax_logic::setting::SettingId;
use tiny_http::{Header, Method, Request, Response, Server};

use self::view::View;

const PAGE: &str = include_str!("web/page.html");
const EVENT_EVERY: Duration = Duration::from_millis(50);
/// Longest line for the bench or the player, bytes.
const ACT_MAX: usize = 40;

pub struct Web {
    server: Server,
    view: Arc<Mutex<View>>,
    commands: Sender<Down>,
    /// Lines for the scene's bench or the player: never a command of the board's line.
    bench: Sender<String>,
    control: bool,
    port: u16,
}

fn lock(view: &Mutex<View>) -> MutexGuard<'_, View> {
    view.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Web {
    /// Watches a board, for a page on this port of 127.0.0.1; 0: any free port. Fails if the port cannot be had.
    pub fn new(line: &Target, truth: Option<&Target>, control: bool, port: u16) -> anyhow::Result<Self> {
        let server = Server::http((Ipv4Addr::LOCALHOST, port)).map_err(|error| {
            anyhow!("cannot serve a page on port {port}: choose another, or 0 for any that is free: {error}")
        })?;
        let port = server.server_addr().to_ip().map_or(port, |address| address.port());
        let (commands, waiting) = channel();
        let (sender, news) = channel();
        let view = Arc::<Mutex<View>>::default();
        lock(&view).tell(json!({ "place": line.to_string(), "missed": 0, "bad_frames": 0 }));
        let bench = source::start(line, truth, waiting, sender);
        let own = Arc::clone(&view);
        thread::spawn(move || news.into_iter().for_each(|news| lock(&own).take(news)));
        Ok(Self { server, view, commands, bench, control, port })
    }

    pub fn place(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    pub fn serve(&self) {
        thread::scope(|scope| {
            for request in self.server.incoming_requests() {
                // A client that leaves is no error.
                scope.spawn(|| drop(self.answer(request)));
            }
        });
    }

    fn view(&self) -> MutexGuard<'_, View> {
        lock(&self.view)
    }

    /// Whether a page of this address sent the request.
    fn is_ours(&self, request: &Request) -> bool {
        let header = |name: &'static str| {
            request.headers().iter().find(|header| header.field.equiv(name)).map(|own| own.value.as_str())
        };
        let ours = ["127.0.0.1", "localhost"].map(|host| format!("{host}:{}", self.port));
        let is_ours = |host: &str| ours.iter().any(|own| own == host);
        header("Host").is_some_and(is_ours)
            && header("Origin").is_none_or(|origin| origin.strip_prefix("http://").is_some_and(is_ours))
    }

    fn answer(&self, request: Request) -> io::Result<()> {
        let path = request.url().to_owned();
        let (status, kind, body) = match (request.method(), path.as_str()) {
            _ if !self.is_ours(&request) => {
                (403, "text/plain", "only pages of this address may ask".to_owned())
            }
            (Method::Get, "/") => (200, "text/html; charset=utf-8", PAGE.to_owned()),
            (Method::Get, "/settings") => {
                (200, "application/json", self.view().settings(self.control).to_string())
            }
            (Method::Get, "/settings.toml") => match self.view().backup() {
                Some(text) => (200, "application/toml", text),
                None => (404, "text/plain", "the board has not said who it is".to_owned()),
            },
            (Method::Get, "/events") => return self.events(request.into_writer()),
            (Method::Post, path) => {
                let (status, text) = self.post(path);
                (status, "text/plain", text)
            }
            _ => (404, "text/plain", "there is no such page".to_owned()),
        };
        let headers = [("Content-Type", kind), ("X-Content-Type-Options", "nosniff")];
        let mut response = Response::from_string(body).with_status_code(status);
        for header in headers.iter().filter_map(|(name, value)| Header::from_bytes(*name, *value).ok()) {
            response.add_header(header);
        }
        request.respond(response)
    }

    /// Carries out a request of the page, if that is allowed: status and text of the answer.
    fn post(&self, path: &str) -> (u16, String) {
        if let Some(words) = path.strip_prefix("/selftest/") {
            let words: Vec<String> = words.split('/').map(str::to_owned).collect();
            return match self.view().selftest(&words) {
                Ok(()) => (202, "done".to_owned()),
                Err(why) => (409, format!("{why:#}")),
            };
        }
        let (status, text) = match (words(path, "/play/"), words(path, "/bench/"), command(path)) {
            (Some(control), ..) => match self.bench.send(control) {
                Ok(()) => (202, "done"),
                Err(_) => (404, "this is no recording"),
            },
            (_, None, None) => (404, "no such command"),
            _ if !self.control => (403, "read only: start with --control to change anything"),
            (_, Some(act), _) => {
                let mut view = self.view();
                if !view.state().get("bench").is_some_and(Value::is_array) {
                    (404, "no bench: only a served scene has one, where --truth says")
                } else {
                    view.say(&format!("at the bench: {act}"));
                    sent(self.bench.send(act).is_ok())
                }
            }
            (.., Some(command)) => sent(self.commands.send(command).is_ok()),
        };
        (status, text.to_owned())
    }

    /// Sends the state and its changes, for as long as the page is open.
    fn events(&self, mut page: Box<dyn Write + Send>) -> io::Result<()> {
        write!(
            page,
            "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n"
        )?;
        let changes = self.view().join();
        for first in &changes {
            let batch: Vec<Value> = iter::once(first).chain(changes.try_iter()).collect();
            write!(page, "data: {}\n\n", Value::Array(batch))?;
            page.flush()?;
            thread::sleep(EVENT_EVERY);
        }
        Ok(())
    }
}

const fn sent(is_sent: bool) -> (u16, &'static str) {
    if is_sent { (202, "sent") } else { (503, "there is no line") }
}

/// The line for the bench or the player in a path: `/bench/tap/pvdf_3`, `/play/+5`.
fn words(path: &str, stem: &str) -> Option<String> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || "_./+-".contains(c);
    let act = path.strip_prefix(stem).filter(|act| act.len() <= ACT_MAX && act.chars().all(is_word))?;
    Some(act.replace('/', " "))
}

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
