//! Plays a recording's line for the page of `tenax monitor`, at its pace or another, from any second.

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
    #[cfg(feature = "host")]
    pub fn open(path: &std::path::Path) -> anyhow::Result<Self> {
        Ok(Self::of(Captured::open(path)?))
    }

    pub fn of(captured: Captured) -> Self {
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
        Self { line, frames }
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

/// A reel that plays by a clock of its user's, s from any instant.
pub struct Player {
    reel: Reel,
    now: Playing,
    inbox: Inbox,
    next: usize,
    /// An instant of the clock, and the recording's time then, s.
    since: (f64, f64),
}

impl Player {
    pub fn new(reel: Reel, clock_s: f64) -> Self {
        let now = Playing { at_s: 0.0, of_s: reel.length_s(), speed: 1.0, repeat: false, paused: false };
        Self { reel, now, inbox: Inbox::default(), next: 0, since: (clock_s, 0.0) }
    }

    pub const fn playing(&self) -> Playing {
        self.now
    }

    /// Time until the next frame is due, s. None while it is paused, and at its end.
    pub fn due_s(&self, clock_s: f64) -> Option<f64> {
        let (at_s, _) = self.reel.frames.get(self.next).filter(|_| !self.now.paused)?;
        Some(((at_s - self.since.1).max(0.0) / self.now.speed - (clock_s - self.since.0)).max(0.0))
    }

    /// Plays the next frame. False: `tell` returned false.
    pub fn step(&mut self, clock_s: f64, tell: &mut dyn FnMut(Told) -> bool) -> bool {
        let Some(&(at_s, _)) = self.reel.frames.get(self.next) else { return true };
        let is_told = (at_s / TOLD_EACH_S).floor() > (self.now.at_s / TOLD_EACH_S).floor();
        self.now.at_s = at_s;
        let heard = self.reel.message(self.next, &mut self.inbox).map(Box::new);
        self.next += 1;
        if heard.is_some_and(|heard| !tell(Told::Message(heard))) || is_told && !tell(Told::At(self.now)) {
            return false;
        }
        !(self.now.repeat && self.next == self.reel.frames.len()) || self.jump(0.0, clock_s, tell)
    }

    /// Does what a line says: `12.5` (that second), `+5` and `-5` (by seconds), `x2` (speed), `loop` and `pause`; at the end these two begin
    /// it again. False: `tell` returned false.
    pub fn control(&mut self, line: &str, clock_s: f64, tell: &mut dyn FnMut(Told) -> bool) -> bool {
        let is_over = self.next == self.reel.frames.len();
        let begins = is_over && ["loop", "pause"].contains(&line);
        let to_s = self.now.control(line).or(begins.then_some(0.0));
        self.now.paused &= !is_over;
        self.now.at_s = to_s.unwrap_or(self.now.at_s);
        self.since = (clock_s, self.now.at_s);
        tell(Told::At(self.now)) && to_s.is_none_or(|to_s| self.jump(to_s, clock_s, tell))
    }

    fn jump(&mut self, to_s: f64, clock_s: f64, tell: &mut dyn FnMut(Told) -> bool) -> bool {
        self.next = self.reel.frames.partition_point(|(at_s, _)| *at_s < to_s);
        (self.inbox, self.now.at_s, self.since) = (Inbox::default(), to_s, (clock_s, to_s));
        tell(Told::Again) && tell_beginning(&self.reel, to_s, tell)
    }
}

/// Plays until `tell` returns false or the controls end: lines for [`Player::control`].
pub fn play(reel: Reel, controls: &Receiver<String>, tell: &mut dyn FnMut(Told) -> bool) {
    let began = Instant::now();
    let clock_s = || began.elapsed().as_secs_f64();
    let mut player = Player::new(reel, clock_s());
    let mut goes_on = tell(Told::At(player.playing()));
    while goes_on {
        let control = match player.due_s(clock_s()) {
            Some(due_s) => controls.recv_timeout(Duration::from_secs_f64(due_s)),
            None => controls.recv().map_err(|_| RecvTimeoutError::Disconnected),
        };
        goes_on = match control {
            Err(RecvTimeoutError::Disconnected) => return,
            Err(RecvTimeoutError::Timeout) => player.step(clock_s(), tell),
            Ok(line) => player.control(&line, clock_s(), tell),
        };
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
