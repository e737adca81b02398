//! What really happens in a scene whose board's line is served, beside that line: a line of JSON for each instant, on a
//! TCP port of its own. A real board has none; whoever watches one sees only what it says.

use std::io::{BufRead, BufReader, Read};
use std::thread;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::link::{Target, is_silence};

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

/// Listens for as long as `tell` is true, which is told; to whoever is there next, if it goes away.
pub fn watch(target: &Target, tell: &mut dyn FnMut(Truth) -> bool) {
    loop {
        if let Ok(line) = target.open()
            && !listen(line.up, tell)
        {
            return;
        }
        thread::sleep(AGAIN_AFTER);
    }
}

/// Until it ends. False: nobody wants to know any more.
fn listen(up: impl Read, tell: &mut dyn FnMut(Truth) -> bool) -> bool {
    let (mut lines, mut text) = (BufReader::new(up), String::new());
    loop {
        match lines.read_line(&mut text) {
            Ok(0) => return true,
            Ok(_) => {
                if let Ok(truth) = serde_json::from_str(&text)
                    && !tell(truth)
                {
                    return false;
                }
                text.clear();
            }
            // What came of a line so far is in `text`.
            Err(error) if is_silence(&error) => {}
            Err(_) => return true,
        }
    }
}
