//! The page of `tenax monitor`, in a browser of this machine. Changes come as server-sent events, at most twenty a second. Only this
//! machine is served, and only pages of this address may ask: a page of another site in the same browser may not.

pub mod pages;
pub mod source;

use std::io::{self, Write};
use std::iter;
use std::net::Ipv4Addr;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, SystemTime};

use anyhow::anyhow;
use serde_json::{Value, json};
use tenax_frames::link::Target;
use tenax_hal_shim::wire::Down;
use tiny_http::{Method, Request, Server};

use self::pages::Pages;
use crate::view::command;

/// Path, kind and content of each file of the page.
const FILES: [(&str, &str, &str); 9] = [
    ("/index.html", "text/html; charset=utf-8", include_str!("../../page/www/index.html")),
    ("/style.css", "text/css", include_str!("../../page/www/style.css")),
    ("/main.js", "text/javascript", include_str!("../../page/www/main.js")),
    ("/sources.js", "text/javascript", include_str!("../../page/www/sources.js")),
    ("/worker.js", "text/javascript", include_str!("../../page/www/worker.js")),
    ("/plots.js", "text/javascript", include_str!("../../page/www/plots.js")),
    ("/stage.js", "text/javascript", include_str!("../../page/www/stage.js")),
    ("/panels.js", "text/javascript", include_str!("../../page/www/panels.js")),
    ("/icon.svg", "image/svg+xml", include_str!("../../page/www/icon.svg")),
];
const EVENT_EVERY: Duration = Duration::from_millis(50);
/// Longest line for the player, bytes.
const CONTROL_MAX: usize = 40;

pub struct Web {
    server: Server,
    pages: Arc<Mutex<Pages>>,
    commands: Sender<Down>,
    player: Sender<String>,
    control: bool,
    port: u16,
}

fn lock(pages: &Mutex<Pages>) -> MutexGuard<'_, Pages> {
    pages.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Web {
    /// Watches a board, for a page on this port of 127.0.0.1; 0: any free port. Fails if the port cannot be had.
    pub fn new(line: &Target, control: bool, port: u16) -> anyhow::Result<Self> {
        let server = Server::http((Ipv4Addr::LOCALHOST, port)).map_err(|error| {
            anyhow!("cannot serve a page on port {port}: choose another, or 0 for any that is free: {error}")
        })?;
        let port = server.server_addr().to_ip().map_or(port, |address| address.port());
        let (commands, waiting) = channel();
        let (sender, news) = channel();
        let pages = Arc::<Mutex<Pages>>::default();
        let place = json!({ "place": line.to_string(), "missed": 0, "bad_frames": 0 });
        lock(&pages).with(|view| view.tell(place));
        let player = source::start(line, waiting, sender);
        let own = Arc::clone(&pages);
        thread::spawn(move || news.into_iter().for_each(|news| lock(&own).take(news)));
        Ok(Self { server, pages, commands, player, control, port })
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

    fn pages(&self) -> MutexGuard<'_, Pages> {
        lock(&self.pages)
    }

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
        let text = |status, text: &str| (status, "text/plain", text.to_owned().into_bytes());
        let (status, kind, body) = match (request.method(), path.as_str()) {
            _ if !self.is_ours(&request) => text(403, "only pages of this address may ask"),
            (Method::Get, "/events") => return self.events(request.into_writer()),
            (Method::Get, "/settings") => {
                let settings = self.pages().view.settings(self.control).to_string();
                (200, "application/json", settings.into_bytes())
            }
            (Method::Get, "/settings.toml") => match self.pages().view.backup(SystemTime::now()) {
                Some(text) => (200, "application/toml", text.into_bytes()),
                None => text(404, "the board has not said who it is"),
            },
            (Method::Get, path) => file(path).unwrap_or_else(|| text(404, "there is no such page")),
            (Method::Post, path) => {
                let (status, said) = self.post(path);
                text(status, &said)
            }
            _ => text(404, "there is no such page"),
        };
        // Closed after each answer: the server has a thread a connection, and one that is kept open holds up another.
        let mut page = request.into_writer();
        write!(
            page,
            "HTTP/1.1 {status} -\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nX-Content-Type-Options: nosniff\r\n\
             Cache-Control: no-store\r\nConnection: close\r\n\r\n",
            body.len()
        )?;
        page.write_all(&body)?;
        page.flush()
    }

    /// Carries out a request of the page, if that is allowed: status and text of the answer.
    fn post(&self, path: &str) -> (u16, String) {
        if let Some(words) = path.strip_prefix("/selftest/") {
            let words: Vec<String> = words.split('/').map(str::to_owned).collect();
            return match self.pages().with(|view| view.selftest(&words)) {
                Ok(()) => (202, "done".to_owned()),
                Err(why) => (409, format!("{why:#}")),
            };
        }
        let (status, text) = match (control_in(path), command(path)) {
            (Some(control), _) => match self.player.send(control) {
                Ok(()) => (202, "done"),
                Err(_) => (404, "this is no recording"),
            },
            (None, None) => (404, "no such command"),
            _ if !self.control => (403, "read only: start with --control to change anything"),
            (None, Some(command)) => match self.commands.send(command) {
                Ok(()) => (202, "sent"),
                Err(_) => (503, "there is no line"),
            },
        };
        (status, text.to_owned())
    }

    /// Sends the state and its changes, for as long as the page is open.
    fn events(&self, mut page: Box<dyn Write + Send>) -> io::Result<()> {
        write!(
            page,
            "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n"
        )?;
        let changes = self.pages().join();
        for first in &changes {
            let batch: Vec<Value> = iter::once(first).chain(changes.try_iter()).collect();
            write!(page, "data: {}\n\n", Value::Array(batch))?;
            page.flush()?;
            thread::sleep(EVENT_EVERY);
        }
        Ok(())
    }
}

/// Status, kind and content of a file of the page. What needs its machine, bench and Web Serial, is not served.
fn file(path: &str) -> Option<(u16, &'static str, Vec<u8>)> {
    let path = if path == "/" { "/index.html" } else { path };
    let (_, kind, text) = FILES.iter().find(|(name, ..)| *name == path)?;
    // The page then watches this server.
    Some((200, *kind, text.replace("<html ", "<html data-monitor ").into_bytes()))
}

/// The line for the player in a path: `/play/+5`.
fn control_in(path: &str) -> Option<String> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || "./+-".contains(c);
    let control = path.strip_prefix("/play/")?;
    (control.len() <= CONTROL_MAX && control.chars().all(is_word)).then(|| control.replace('/', " "))
}
