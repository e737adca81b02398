//! What really happens in a scene whose board's line is served, beside that line: a line of JSON for each instant, on a
//! TCP port of its own. A real board has none; whoever watches one sees only what it says.
//!
//! The first line names what somebody may do at the scene's bench. Lines that go back, such as `g`, are done there: no message
//! of the board's line can say them, so that no page grips with a real hand.

use std::io::{BufRead, BufReader, Write};
use std::sync::mpsc::Receiver;
use std::thread;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::link::{Line, Target, is_silence};

/// Rows of the world's trace for each line: 50 lines a second.
pub const ROWS: u32 = 4;
/// Pause before somebody who has gone is asked again.
const AGAIN_AFTER: Duration = Duration::from_millis(500);

/// What is true at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    pub t_s: f64,
    /// How fast the object slides over the pad, mm/s.
    pub slide_mm_s: f64,
    /// The part of the contact that sticks, 0 to 1. Below 1 while something is held: micro slip.
    pub stuck_part: f64,
    /// Force of each finger, N.
    pub grip_n: f64,
    /// The least that would hold, N; 0 while the hand carries nothing.
    pub needed_n: f64,
    /// Slips so far that nobody meant.
    pub slips: usize,
    /// How far it has slid in them, mm.
    pub slipped_mm: f64,
    pub dropped: bool,
}

impl Truth {
    /// What slides, in a word.
    pub const fn contact(&self) -> &'static str {
        if self.grip_n <= 0.0 {
            "no contact"
        } else if self.stuck_part <= 0.0 {
            "slides"
        } else if self.stuck_part < 1.0 {
            "micro slip"
        } else {
            "sticks"
        }
    }
}

/// One thing that can be done at the bench: the line that says it, and what it is for a person.
pub type Key = (String, String);

/// What can be done at the bench.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bench {
    pub keys: Vec<Key>,
}

/// What is heard there.
#[derive(Clone, Debug)]
pub enum Told {
    Truth(Truth),
    /// None: the scene is gone.
    Bench(Option<Bench>),
}

/// Listens for as long as `tell` is true, which is told; to whoever is there next, if it goes away. Passes on what is done
/// at the bench.
pub fn watch(target: &Target, acts: &Receiver<String>, tell: &mut dyn FnMut(Told) -> bool) {
    loop {
        if let Ok(line) = target.open() {
            // Nobody was there to do it.
            acts.try_iter().for_each(drop);
            if !listen(line, acts, tell) || !tell(Told::Bench(None)) {
                return;
            }
        }
        thread::sleep(AGAIN_AFTER);
    }
}

/// Until it ends. False: nobody wants to know any more.
fn listen(line: Line, acts: &Receiver<String>, tell: &mut dyn FnMut(Told) -> bool) -> bool {
    let (mut lines, mut text, mut down) = (BufReader::new(line.up), String::new(), line.down);
    loop {
        match lines.read_line(&mut text) {
            Ok(0) => return true,
            Ok(_) => {
                let truth = serde_json::from_str(&text).map(Told::Truth);
                let told =
                    truth.or_else(|_| serde_json::from_str(&text).map(|bench| Told::Bench(Some(bench))));
                if let Ok(told) = told
                    && !tell(told)
                {
                    return false;
                }
                text.clear();
            }
            // What came of a line so far is in `text`.
            Err(error) if is_silence(&error) => {}
            Err(_) => return true,
        }
        let Some(down) = &mut down else { continue };
        if acts.try_iter().any(|act| writeln!(down, "{act}").is_err()) {
            return true;
        }
    }
}
