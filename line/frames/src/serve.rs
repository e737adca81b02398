//! A running board's line for other programs, live: on a pseudo-terminal and on TCP, as a real board's on its serial port. Every client
//! gets each frame that comes up the line; what clients send goes down it frame by frame. All see the answers to all commands. The run
//! never waits: a client that does not keep up loses whole messages, which are counted, and shows gaps in their numbers.

mod hub;
#[cfg(unix)]
mod pty;

use std::fmt::{self, Display};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use self::hub::{Framer, Hub};

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
pub type Down = Arc<Mutex<Receiver<Vec<u8>>>>;

pub struct Server {
    hub: Arc<Hub>,
    framer: Framer,
    places: Vec<String>,
    doors: Vec<JoinHandle<()>>,
}

impl Server {
    /// Begins to serve. Fails if a place cannot be had; says which and what to do.
    pub fn start(options: &Options) -> anyhow::Result<(Self, Down)> {
        let (down, bytes) = sync_channel(DOWN_FRAMES);
        let hub = Hub::new(down);
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
        if let Some(port) = options.tcp {
            let (place, door) = hub.serve_tcp(port)?;
            places.push(place);
            doors.push(door);
        }
        Ok((Self { hub, framer: Framer::default(), places, doors }, Arc::new(Mutex::new(bytes))))
    }

    pub fn line(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            if let Some(frame) = self.framer.push(byte) {
                self.hub.publish(&frame);
            }
        }
    }

    pub fn places(&self) -> &[String] {
        &self.places
    }

    /// Ends when every client has read what is left, at most 0.5 s later.
    pub fn close(self) -> Tally {
        self.hub.close(LAST_READ);
        for door in self.doors {
            let _panicked = door.join();
        }
        self.hub.tally()
    }
}
