//! A recording's line once more, at its pace or another, from any second: for `tenax play`, and for screen and page of
//! `tenax monitor`.

mod reel;

use std::str::FromStr;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;
use tenax_hal_shim::wire::Up;

pub use self::reel::Reel;
use crate::link::Heard;

/// Of a recording's time, how often it is told where it is, s.
const TOLD_EACH_S: f64 = 0.1;
/// The speeds that there are, times as fast as it was recorded.
pub const SPEEDS: (f64, f64) = (0.01, 100.0);

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Playing {
    pub at_s: f64,
    pub of_s: f64,
    /// Times as fast as it was recorded.
    pub speed: f64,
    /// It begins again when it is over.
    pub repeat: bool,
    pub paused: bool,
}

impl Playing {
    /// From the beginning, as fast as it was recorded.
    pub const fn new(reel: &Reel) -> Self {
        Self { at_s: 0.0, of_s: reel.length_s(), speed: 1.0, repeat: false, paused: false }
    }
}

/// What a person may do with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Control {
    /// Goes on from here, s.
    Seek(f64),
    /// Goes so far, s, back if it is below 0.
    Step(f64),
    Speed(f64),
    Loop,
    Pause,
}

impl FromStr for Control {
    type Err = ();

    /// `12.5`, `+5`, `-5`, `x2`, `loop`, `pause`.
    fn from_str(line: &str) -> Result<Self, ()> {
        let number = |text: &str| text.parse().ok().filter(|number: &f64| number.is_finite()).ok_or(());
        match line {
            "loop" => Ok(Self::Loop),
            "pause" => Ok(Self::Pause),
            _ if line.starts_with(['+', '-']) => number(line).map(Self::Step),
            _ => match line.strip_prefix('x') {
                Some(speed) => number(speed).map(Self::Speed),
                None => number(line).map(Self::Seek),
            },
        }
    }
}

/// What is told of a recording that is played.
#[derive(Debug)]
pub enum Told {
    Message(Box<Heard>),
    /// It goes on elsewhere: what was heard so far is no more so.
    Again,
    At(Playing),
    /// It is over, and does not begin again.
    Over,
}

/// Plays until `tell` is false, or does not want to go on when it is over. Lines that are no [`Control`] are passed over.
/// Fails if the recording cannot be read.
pub fn play(
    reel: &mut Reel,
    playing: Playing,
    controls: &Receiver<String>,
    tell: &mut dyn FnMut(Told) -> bool,
) -> anyhow::Result<()> {
    let mut player = Player { playing, controls, tell };
    // What stays so is at the beginning: who the board is, and its settings.
    let beginning = reel.piece(0)?.unwrap_or_default();
    let mut is_first = true;
    loop {
        let from_s = player.playing.at_s.clamp(0.0, reel.length_s());
        let mut n = reel.piece_at(from_s);
        player.playing.at_s = from_s;
        if !is_first && !(player.tell)(Told::Again) {
            return Ok(());
        }
        is_first = false;
        let mut early =
            beginning.iter().filter(|(at_s, heard)| *at_s < from_s && stays(&heard.received.message));
        if !early.all(|(_, heard)| (player.tell)(Told::Message(Box::new(heard.clone())))) {
            return Ok(());
        }
        let mut next = player.piece(&reel.piece(n)?.unwrap_or_default(), from_s);
        while next == Next::Goes {
            n += 1;
            next = match reel.piece(n)? {
                Some(said) => player.piece(&said, from_s),
                None => player.is_over(),
            };
        }
        if next == Next::Ends {
            return Ok(());
        }
    }
}

fn stays(message: &Up) -> bool {
    matches!(message, Up::About(_) | Up::Answer { .. })
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Next {
    Goes,
    Jumps,
    Ends,
}

struct Player<'a> {
    playing: Playing,
    controls: &'a Receiver<String>,
    tell: &'a mut dyn FnMut(Told) -> bool,
}

impl Player<'_> {
    /// Says each message from `from_s` on when it is due.
    fn piece(&mut self, said: &[(f64, Heard)], from_s: f64) -> Next {
        let mut clock = (Instant::now(), self.playing.at_s);
        for (at_s, heard) in said.iter().filter(|(at_s, _)| *at_s >= from_s) {
            loop {
                let due = Duration::from_secs_f64((at_s - clock.1).max(0.0) / self.playing.speed);
                let left = due.saturating_sub(clock.0.elapsed());
                let control = match (self.playing.paused, left.is_zero()) {
                    (true, _) => self.controls.recv().ok(),
                    (false, true) => self.controls.try_recv().ok(),
                    (false, false) => match self.controls.recv_timeout(left) {
                        Ok(control) => Some(control),
                        Err(RecvTimeoutError::Timeout) => None,
                        Err(RecvTimeoutError::Disconnected) => {
                            thread::sleep(left);
                            None
                        }
                    },
                };
                let is_due = !self.playing.paused && left.is_zero();
                match control.and_then(|line| line.parse().ok()) {
                    Some(control) => {
                        let jumps = self.control(control);
                        clock = (Instant::now(), self.playing.at_s);
                        if !(self.tell)(Told::At(self.playing)) {
                            return Next::Ends;
                        }
                        if jumps {
                            return Next::Jumps;
                        }
                    }
                    // Nobody is there any more who could let it go on.
                    None if self.playing.paused => return Next::Ends,
                    None if is_due => break,
                    None => {}
                }
            }
            let told = (self.playing.at_s / TOLD_EACH_S).floor();
            self.playing.at_s = self.playing.at_s.max(*at_s);
            let is_told = (self.playing.at_s / TOLD_EACH_S).floor() > told;
            if !(self.tell)(Told::Message(Box::new(heard.clone())))
                || is_told && !(self.tell)(Told::At(self.playing))
            {
                return Next::Ends;
            }
        }
        Next::Goes
    }

    /// Does it. True: it goes on elsewhere.
    fn control(&mut self, control: Control) -> bool {
        let Playing { at_s, of_s, speed, repeat, paused } = &mut self.playing;
        match control {
            Control::Seek(to_s) => *at_s = to_s.clamp(0.0, *of_s),
            Control::Step(by_s) => *at_s = (*at_s + by_s).clamp(0.0, *of_s),
            Control::Speed(times) => *speed = times.clamp(SPEEDS.0, SPEEDS.1),
            Control::Loop => *repeat = !*repeat,
            Control::Pause => *paused = !*paused,
        }
        matches!(control, Control::Seek(_) | Control::Step(_))
    }

    /// All is said.
    fn is_over(&mut self) -> Next {
        let mut goes_on = self.playing.repeat;
        if !goes_on && !(self.tell)(Told::Over) {
            return Next::Ends;
        }
        while !goes_on {
            let Ok(line) = self.controls.recv() else { return Next::Ends };
            let Ok(control) = line.parse() else { continue };
            if self.control(control) {
                return Next::Jumps;
            }
            // Whoever lets it go on at its end sees it again.
            goes_on = matches!(control, Control::Loop | Control::Pause);
            self.playing.paused = false;
        }
        self.playing.at_s = 0.0;
        Next::Jumps
    }
}
