//! Plays a recording's line, at its pace or another, from any second: for `tenax play` and the page of `tenax monitor`.

use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;
use tenax_hal_shim::wire::Up;

use crate::link::captured::line_of;
use crate::link::{Heard, Inbox};
use crate::words::seconds;

/// Interval of [`Told::At`], s of the recording.
const TOLD_EACH_S: f64 = 0.1;
/// Who the board is and its settings come within this time, s: they are told wherever playing begins.
const BEGINNING_S: f64 = 2.0;
/// The slowest and the fastest speed, times real time.
pub const SPEEDS: (f64, f64) = (0.01, 100.0);

/// A recording: its line, and time (s) and place of each slow frame.
pub struct Reel {
    line: Vec<u8>,
    places: Vec<(f64, usize)>,
    length_s: f64,
}

impl Reel {
    /// Fails if the file cannot be read, or holds no message of a board.
    pub fn open(path: &Path) -> anyhow::Result<Self> {
        let line = line_of(path)?;
        let (mut inbox, mut places, mut begin) = (Inbox::default(), Vec::new(), 0);
        // A board that starts anew counts from 0 again: its time goes on.
        let (mut at_s, mut zero_s) = (0.0, None);
        for (n, &byte) in line.iter().enumerate() {
            let Some(frame) = inbox.push(byte) else { continue };
            match frame.map(|heard| heard.received.message) {
                Ok(Up::Hello { .. }) => zero_s = Some(at_s),
                Ok(Up::Slow(slow)) => {
                    let board_s = seconds(slow.frame);
                    at_s = board_s + *zero_s.get_or_insert(-board_s);
                    places.push((at_s, begin));
                }
                _ => {}
            }
            begin = n + 1;
        }
        Ok(Self { line, places, length_s: at_s })
    }

    pub const fn length_s(&self) -> f64 {
        self.length_s
    }

    /// The messages from the slow frame at `from_s` on, each with its time, s.
    fn messages(&self, from_s: f64) -> impl Iterator<Item = (f64, Heard)> {
        let mut next = self.places.partition_point(|(at_s, _)| *at_s < from_s);
        let before = next.checked_sub(1).map(|n| self.places[n].0);
        let begin = if next == 0 { 0 } else { self.places.get(next).map_or(self.line.len(), |(_, at)| *at) };
        let (mut inbox, mut at_s) = (Inbox::default(), before.unwrap_or(0.0));
        self.line[begin..].iter().filter_map(move |&byte| inbox.push(byte)).flatten().map(move |heard| {
            if let (Up::Slow(_), Some((slow_s, _))) = (&heard.received.message, self.places.get(next)) {
                at_s = *slow_s;
                next += 1;
            }
            (at_s, heard)
        })
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Playing {
    pub at_s: f64,
    pub of_s: f64,
    /// Times real time.
    pub speed: f64,
    /// It begins again when it is over.
    pub repeat: bool,
    pub paused: bool,
}

impl Playing {
    /// From the beginning, in real time.
    pub const fn new(reel: &Reel) -> Self {
        Self { at_s: 0.0, of_s: reel.length_s(), speed: 1.0, repeat: false, paused: false }
    }

    /// Does what a line says. Some(true): playing goes on elsewhere. None: the line is no control.
    fn control(&mut self, line: &str) -> Option<bool> {
        let number = |text: &str| text.parse().ok().filter(|number: &f64| number.is_finite());
        match line {
            "loop" => self.repeat = !self.repeat,
            "pause" => self.paused = !self.paused,
            _ => match line.strip_prefix('x') {
                Some(speed) => self.speed = number(speed)?.clamp(SPEEDS.0, SPEEDS.1),
                None => {
                    let from_s = if line.starts_with(['+', '-']) { self.at_s } else { 0.0 };
                    self.at_s = (from_s + number(line)?).clamp(0.0, self.of_s);
                    return Some(true);
                }
            },
        }
        Some(false)
    }
}

#[derive(Debug)]
pub enum Told {
    Message(Box<Heard>),
    /// Playing goes on elsewhere: state from earlier messages is void.
    Again,
    At(Playing),
    /// It is over, and does not begin again by itself.
    Over,
}

/// Why playing stopped.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stop {
    AtEnd,
    Jump,
    /// Nobody listens, or nobody is left who could let it go on.
    Left,
}

/// Plays until `tell` returns false, or the controls end while it stands still. Lines that are no control are ignored: `12.5`
/// (that second), `+5` and `-5` (by seconds), `x2` (speed), `loop` and `pause` are.
pub fn play(
    reel: &Reel,
    mut playing: Playing,
    controls: &Receiver<String>,
    tell: &mut dyn FnMut(Told) -> bool,
) {
    loop {
        match play_on(reel, &mut playing, controls, tell) {
            Stop::Left => return,
            Stop::AtEnd if playing.repeat => playing.at_s = 0.0,
            Stop::AtEnd => {
                if !tell(Told::Over) || !wait_at_end(&mut playing, controls) {
                    return;
                }
            }
            Stop::Jump => {}
        }
        if !tell(Told::Again) {
            return;
        }
    }
}

/// Waits for a control that begins it again. False: there are no more.
fn wait_at_end(playing: &mut Playing, controls: &Receiver<String>) -> bool {
    for line in controls {
        let jumps = playing.control(&line) == Some(true);
        playing.paused = false;
        if ["loop", "pause"].contains(&line.as_str()) {
            playing.at_s = 0.0;
            return true;
        }
        if jumps {
            return true;
        }
    }
    false
}

fn play_on(
    reel: &Reel,
    playing: &mut Playing,
    controls: &Receiver<String>,
    tell: &mut dyn FnMut(Told) -> bool,
) -> Stop {
    playing.at_s = playing.at_s.clamp(0.0, reel.length_s());
    let from_s = playing.at_s;
    let stays = |message: &Up| matches!(message, Up::About(_) | Up::Answer { .. });
    let beginning = reel.messages(0.0).take_while(|(at_s, _)| *at_s < BEGINNING_S.min(from_s));
    for (_, heard) in beginning.filter(|(_, heard)| stays(&heard.received.message)) {
        if !tell(Told::Message(Box::new(heard))) {
            return Stop::Left;
        }
    }
    let mut clock = (Instant::now(), from_s);
    for (at_s, heard) in reel.messages(from_s) {
        loop {
            let due = Duration::from_secs_f64((at_s - clock.1).max(0.0) / playing.speed);
            let left = due.saturating_sub(clock.0.elapsed());
            let control = match (playing.paused, controls.recv_timeout(left)) {
                (_, Ok(control)) => Some(control),
                (true, Err(_)) => controls.recv().ok(),
                (false, Err(RecvTimeoutError::Timeout)) => None,
                (false, Err(RecvTimeoutError::Disconnected)) => {
                    thread::sleep(left);
                    None
                }
            };
            match control {
                Some(line) => {
                    let Some(jumps) = playing.control(&line) else { continue };
                    clock = (Instant::now(), playing.at_s);
                    if !tell(Told::At(*playing)) {
                        return Stop::Left;
                    }
                    if jumps {
                        return Stop::Jump;
                    }
                }
                None if playing.paused => return Stop::Left,
                None => break,
            }
        }
        let is_told = (at_s / TOLD_EACH_S).floor() > (playing.at_s / TOLD_EACH_S).floor();
        playing.at_s = playing.at_s.max(at_s);
        if !tell(Told::Message(Box::new(heard))) || is_told && !tell(Told::At(*playing)) {
            return Stop::Left;
        }
    }
    Stop::AtEnd
}
