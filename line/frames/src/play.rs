//! Plays a recording's line for the page of `tenax monitor`, at its pace or another, from any second.

use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use serde::Serialize;
use tenax_hal_shim::wire::Up;

use crate::link::{Captured, Clock, Heard, Inbox};

/// Interval of [`Told::At`], s of the recording.
const TOLD_EACH_S: f64 = 0.1;
/// Identity and settings of the board come within this time, s: they are told wherever playing begins.
const BEGINNING_S: f64 = 2.0;
const SPEEDS: (f64, f64) = (0.01, 100.0);

/// A recording's line, and time (s) and end (bytes) of each frame.
pub struct Reel {
    line: Vec<u8>,
    frames: Vec<(f64, usize)>,
}

impl Reel {
    pub fn open(path: &Path) -> anyhow::Result<Self> {
        let captured = Captured::open(path)?;
        let (mut clock, mut frames, mut first_s, mut at_s) = (Clock::default(), Vec::new(), None, 0.0);
        for (end, came_ns, frame) in captured.frames() {
            if let Ok(heard) = frame {
                clock.hear(&heard.received.message, came_ns);
                if let Some(now_s) = clock.last().map(|last| clock.seconds(last)) {
                    at_s = now_s - *first_s.get_or_insert(now_s);
                }
            }
            frames.push((at_s, end));
        }
        let line = captured.line;
        Ok(Self { line, frames })
    }

    fn length_s(&self) -> f64 {
        self.frames.last().map_or(0.0, |(at_s, _)| *at_s)
    }

    /// The message of a frame, if it is one; `inbox` has taken the frame before.
    fn message(&self, n: usize, inbox: &mut Inbox) -> Option<Heard> {
        let begin = n.checked_sub(1).map_or(0, |before| self.frames[before].1);
        self.line[begin..self.frames[n].1].iter().find_map(|&byte| inbox.push(byte))?.ok()
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Playing {
    pub at_s: f64,
    pub of_s: f64,
    pub speed: f64,
    pub repeat: bool,
    pub paused: bool,
}

impl Playing {
    /// Does what a line says. Some: playing goes on at this second. Lines that are no control are ignored.
    fn control(&mut self, line: &str) -> Option<f64> {
        let number = |text: &str| text.parse().ok().filter(|number: &f64| number.is_finite());
        match line {
            "loop" => self.repeat = !self.repeat,
            "pause" => self.paused = !self.paused,
            _ => match line.strip_prefix('x') {
                Some(speed) => self.speed = number(speed)?.clamp(SPEEDS.0, SPEEDS.1),
                None => {
                    let from_s = if line.starts_with(['+', '-']) { self.at_s } else { 0.0 };
                    return Some((from_s + number(line)?).clamp(0.0, self.of_s));
                }
            },
        }
        None
    }
}

#[derive(Debug)]
pub enum Told {
    Message(Box<Heard>),
    /// Playing goes on elsewhere: state from earlier messages is void.
    Again,
    At(Playing),
}

/// Plays until `tell` returns false or the controls end. Controls: `12.5` (that second), `+5` and `-5` (by seconds), `x2` (speed),
/// `loop` and `pause`; at the end these two begin it again.
pub fn play(reel: &Reel, controls: &Receiver<String>, tell: &mut dyn FnMut(Told) -> bool) {
    let mut now = Playing { at_s: 0.0, of_s: reel.length_s(), speed: 1.0, repeat: false, paused: false };
    let (mut inbox, mut next, mut clock) = (Inbox::default(), 0, (Instant::now(), 0.0));
    if !tell(Told::At(now)) {
        return;
    }
    loop {
        let due = reel.frames.get(next).filter(|_| !now.paused).map(|(at_s, _)| {
            let since = Duration::from_secs_f64((at_s - clock.1).max(0.0) / now.speed);
            since.saturating_sub(clock.0.elapsed())
        });
        let control = match due {
            Some(due) => controls.recv_timeout(due),
            None => controls.recv().map_err(|_| RecvTimeoutError::Disconnected),
        };
        let is_over = next == reel.frames.len();
        let to_s = match control {
            Err(RecvTimeoutError::Disconnected) => return,
            Err(RecvTimeoutError::Timeout) => {
                let (at_s, _) = reel.frames[next];
                let is_told = (at_s / TOLD_EACH_S).floor() > (now.at_s / TOLD_EACH_S).floor();
                now.at_s = at_s;
                let heard = reel.message(next, &mut inbox).map(Box::new);
                next += 1;
                if heard.is_some_and(|heard| !tell(Told::Message(heard))) || is_told && !tell(Told::At(now)) {
                    return;
                }
                (now.repeat && next == reel.frames.len()).then_some(0.0)
            }
            Ok(line) => {
                let begins = is_over && ["loop", "pause"].contains(&line.as_str());
                let to_s = now.control(&line).or(begins.then_some(0.0));
                now.paused &= !is_over;
                now.at_s = to_s.unwrap_or(now.at_s);
                clock = (Instant::now(), now.at_s);
                if !tell(Told::At(now)) {
                    return;
                }
                to_s
            }
        };
        if let Some(to_s) = to_s {
            (next, inbox) = (reel.frames.partition_point(|(at_s, _)| *at_s < to_s), Inbox::default());
            (now.at_s, clock) = (to_s, (Instant::now(), to_s));
            if !tell(Told::Again) || !tell_beginning(reel, to_s, tell) {
                return;
            }
        }
    }
}

fn tell_beginning(reel: &Reel, before_s: f64, tell: &mut dyn FnMut(Told) -> bool) -> bool {
    let end = reel.frames.partition_point(|(at_s, _)| *at_s < BEGINNING_S.min(before_s));
    let mut inbox = Inbox::default();
    (0..end)
        .filter_map(|n| reel.message(n, &mut inbox))
        .filter(|heard| matches!(heard.received.message, Up::About(_) | Up::Answer { .. }))
        .all(|heard| tell(Told::Message(Box::new(heard))))
}
