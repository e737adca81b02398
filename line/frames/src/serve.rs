//! A running board's line for other programs, live: on a pseudo-terminal and on TCP, as a real board's on its serial port.
//!
//! Every client gets each frame that comes up the line; what clients send goes down it frame by frame. All see the answers to all
//! commands. The run never waits: a client that does not keep up loses whole messages, which are counted, and shows gaps in
//! their numbers.

mod hub;
#[cfg(unix)]
mod pty;

use std::fmt::{self, Display};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use self::hub::{Frame, Framer, Hub};
use crate::truth::{Key, Truth};

/// Frames on their way down to the board; a client that sends more waits.
const DOWN_FRAMES: usize = 64;
/// Time for clients to read what is left when the run is over.
const LAST_READ: Duration = Duration::from_millis(500);

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    pub pty: bool,
    pub at: Option<PathBuf>,
    /// TCP port of 127.0.0.1; 0: any free port.
    pub tcp: Option<u16>,
    /// TCP port of 127.0.0.1 for the scene's true state; 0: any free port.
    pub truth: Option<u16>,
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

/// A server's other end, for the board that it serves, or for one after the other.
#[derive(Clone)]
pub struct Down {
    pub bytes: Arc<Mutex<Receiver<Vec<u8>>>>,
    pub teller: Teller,
}

pub struct Server {
    hub: Arc<Hub>,
    framer: Framer,
    places: Vec<String>,
    truth: Option<(String, Arc<Hub>)>,
    acts: Option<Receiver<Vec<u8>>>,
    doors: Vec<JoinHandle<()>>,
}

impl Server {
    /// Begins to serve. Fails if a place cannot be had; says which and what to do.
    pub fn start(options: &Options) -> anyhow::Result<(Self, Down)> {
        let (down, bytes) = sync_channel(DOWN_FRAMES);
        let hub = Hub::new(down, 0, None);
        let (mut places, mut doors) = (Vec::new(), Vec::new());
        if options.pty {
            #[cfg(unix)]
            {
                let pty = pty::Pty::new(options.at.as_deref())?;
                places.extend(pty.places());
                let hub = Arc::clone(&hub);
                doors.push(thread::spawn(move || pty.serve(&hub)));
            }
            #[cfg(not(unix))]
            anyhow::bail!("this system has no pseudo-terminals: serve on TCP, with --serve-tcp PORT");
        }
        let mut open = |port, hub: &Arc<Hub>| {
            let (place, door) = hub.serve_tcp(port)?;
            doors.push(door);
            anyhow::Ok(place)
        };
        if let Some(port) = options.tcp {
            places.push(open(port, &hub)?);
        }
        let (act, acts) = sync_channel(DOWN_FRAMES);
        let mut truth = None;
        if let Some(port) = options.truth {
            let bench = serde_json::to_string(&options.keys)? + "\n";
            let hub = Hub::new(act, b'\n', Some(Frame::from(bench.as_bytes())));
            truth = Some((open(port, &hub)?, hub));
        }
        let teller = Teller(truth.as_ref().map(|(_, hub)| Arc::clone(hub)));
        Ok((
            Self { hub, framer: Framer::default(), places, truth, acts: Some(acts), doors },
            Down { bytes: Arc::new(Mutex::new(bytes)), teller },
        ))
    }

    pub fn line(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            if let Some(frame) = self.framer.push(byte) {
                self.hub.publish(&frame);
            }
        }
    }

    /// Address of the scene's true state, for `tenax monitor --truth`.
    pub fn truth_place(&self) -> Option<&str> {
        self.truth.as_ref().map(|(place, _)| place.as_str())
    }

    /// Lines that say what is done at the bench, once. They come with the true state, never on the board's line.
    pub const fn take_acts(&mut self) -> Option<Receiver<Vec<u8>>> {
        self.acts.take()
    }

    pub fn places(&self) -> &[String] {
        &self.places
    }

    /// Ends when every client has read what is left, at most 0.5 s later.
    pub fn close(self) -> Tally {
        self.hub.close(LAST_READ);
        if let Some((_, truth)) = &self.truth {
            truth.close(Duration::ZERO);
        }
        for door in self.doors {
            let _panicked = door.join();
        }
        self.hub.tally()
    }
}

#[derive(Clone, Default)]
pub struct Teller(Option<Arc<Hub>>);

impl Teller {
    pub const fn is_served(&self) -> bool {
        self.0.is_some()
    }

    pub fn tell(&self, truth: &Truth) {
        if let (Some(hub), Ok(text)) = (&self.0, serde_json::to_string(truth)) {
            hub.publish(format!("{text}\n").as_bytes());
        }
    }
}
