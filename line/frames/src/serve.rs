//! A running board's line for other programs, live: on a pseudo-terminal and on TCP, as a real board's on its serial port.
//!
//! Whatever comes up the line goes to every client, frame by frame; whatever a client sends goes down it, frame by frame,
//! so that two who talk at once do not garble each other. It is one line: all clients see the answers to all commands.
//! The run waits for nobody: a client that does not keep up loses whole messages, which are counted here and seen by it
//! as gaps in their numbers.

mod client;
mod framer;
mod hub;
#[cfg(unix)]
mod pty;
mod tcp;

use std::fmt::{self, Display};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use self::client::Ends;
use self::framer::Framer;
use self::hub::Hub;
use crate::truth::{Bench, Key, Truth};

/// Frames on their way down to the board; a client that sends more waits.
const DOWN_FRAMES: usize = 64;
/// How long clients may take to read what is left when the run is over.
const LAST_READ: Duration = Duration::from_millis(500);

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    pub pty: bool,
    /// A symlink to it.
    pub at: Option<PathBuf>,
    /// On this TCP port of 127.0.0.1; 0 is any that is free.
    pub tcp: Option<u16>,
    /// What really happens in the scene, on this TCP port of 127.0.0.1; 0 is any that is free.
    pub truth: Option<u16>,
    /// What somebody may do at the bench, told to whoever hears that.
    pub keys: Vec<Key>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    pub clients: u64,
    /// Messages that were dropped for a client that did not keep up.
    pub dropped: u64,
}

impl Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { clients, dropped } = self;
        write!(f, "{clients} clients, {dropped} messages dropped for those that did not keep up")
    }
}

/// What goes with a server to the board that it serves, or to one after the other.
#[derive(Clone)]
pub struct Down {
    /// Frames that clients send to the board.
    pub bytes: Arc<Mutex<Receiver<Vec<u8>>>>,
    /// Tells what really happens.
    pub teller: Teller,
}

/// Serves a line: it is given what comes up.
pub struct Server {
    hub: Arc<Hub>,
    framer: Framer,
    places: Vec<String>,
    truth: Option<(String, Arc<Hub>)>,
    acts: Option<Receiver<Vec<u8>>>,
    doors: Vec<JoinHandle<()>>,
}

impl Server {
    /// Begins to serve. What comes back with it is the board's. Fails if a place cannot be had; says which and what to do.
    pub fn start(options: &Options) -> anyhow::Result<(Self, Down)> {
        let (down, bytes) = sync_channel(DOWN_FRAMES);
        let hub = Arc::new(Hub::default());
        let ends = Ends { hub: Arc::clone(&hub), down, end: 0 };
        let (mut places, mut doors) = (Vec::new(), Vec::new());
        if options.pty {
            #[cfg(unix)]
            {
                let pty = pty::Pty::new(options.at.as_deref())?;
                places.extend(pty.places());
                let ends = ends.clone();
                doors.push(thread::spawn(move || pty.serve(&ends)));
            }
            #[cfg(not(unix))]
            anyhow::bail!("this system has no pseudo-terminals: serve on TCP, with --serve-tcp PORT");
        }
        if let Some(port) = options.tcp {
            let tcp = tcp::Tcp::new(port)?;
            places.push(tcp.place()?);
            doors.push(thread::spawn(move || tcp.serve(&ends)));
        }
        let (act, acts) = sync_channel(DOWN_FRAMES);
        let truth = options.truth.map(|port| truth_at(port, &options.keys, act, &mut doors)).transpose()?;
        let teller = Teller(truth.as_ref().map(|(_, hub)| Arc::clone(hub)));
        Ok((
            Self { hub, framer: Framer::default(), places, truth, acts: Some(acts), doors },
            Down { bytes: Arc::new(Mutex::new(bytes)), teller },
        ))
    }

    /// Hands on what comes up the line.
    pub fn line(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            if let Some(frame) = self.framer.push(byte) {
                self.hub.publish(&frame);
            }
        }
    }

    /// Where what really happens is told, as `tenax monitor --truth` takes it.
    pub fn truth_place(&self) -> Option<&str> {
        self.truth.as_ref().map(|(place, _)| place.as_str())
    }

    /// Lines that say what is done at the bench, once. They come where what really happens is told, never on the board's line.
    pub const fn take_acts(&mut self) -> Option<Receiver<Vec<u8>>> {
        self.acts.take()
    }

    /// Where it serves, as `tenax monitor --port` takes it.
    pub fn places(&self) -> &[String] {
        &self.places
    }

    pub fn tally(&self) -> Tally {
        self.hub.tally()
    }

    /// Ends when every client has read what is left, or half a second later.
    pub fn close(self) -> Tally {
        self.hub.no_more();
        let began = Instant::now();
        while self.hub.writers() > 0 && began.elapsed() < LAST_READ {
            thread::sleep(Duration::from_millis(5));
        }
        self.hub.close();
        if let Some((_, truth)) = &self.truth {
            truth.no_more();
            truth.close();
        }
        for door in self.doors {
            // A door that panicked has said so.
            let _ = door.join();
        }
        self.hub.tally()
    }
}

/// A port on which what really happens is told, and who hears it. Lines that are sent to it are done at the bench.
fn truth_at(
    port: u16,
    keys: &[Key],
    down: SyncSender<Vec<u8>>,
    doors: &mut Vec<JoinHandle<()>>,
) -> anyhow::Result<(String, Arc<Hub>)> {
    let bench = serde_json::to_string(&Bench { keys: keys.to_vec() })?;
    let hub = Arc::new(Hub::greeting(format!("{bench}\n").as_bytes()));
    let ends = Ends { hub: Arc::clone(&hub), down, end: b'\n' };
    let tcp = tcp::Tcp::new(port)?;
    let place = tcp.place()?;
    doors.push(thread::spawn(move || tcp.serve(&ends)));
    Ok((place, hub))
}

/// Tells what really happens, to whoever listens.
#[derive(Clone, Default)]
pub struct Teller(Option<Arc<Hub>>);

impl Teller {
    /// Whether anybody could listen.
    pub const fn is_served(&self) -> bool {
        self.0.is_some()
    }

    /// What is true at one instant.
    pub fn tell(&self, truth: &Truth) {
        if let (Some(hub), Ok(text)) = (&self.0, serde_json::to_string(truth)) {
            hub.publish(format!("{text}\n").as_bytes());
        }
    }
}
