//! The true state of a served scene: lines of JSON on a TCP port of its own.
//!
//! The first line lists what can be done at the scene's bench. Lines that are sent back, such as `g`, are done there: no message of the
//! board's line can say them, so that no page grips with a real hand.

use std::io::{BufRead, BufReader, Write};
use std::sync::mpsc::Receiver;
use std::thread;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::link::{Line, Target, is_silence};

/// Rows of the world's trace for each line: 50 lines a second.
pub const ROWS: u32 = 4;
const AGAIN_AFTER: Duration = Duration::from_millis(500);

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    pub t_s: f64,
    /// Speed of the object over the pad, mm/s.
    pub slide_mm_s: f64,
    /// The part of the contact that sticks, 0 to 1. Below 1 while something is held: micro slip.
    pub stuck_part: f64,
    /// Force of each finger, N.
    pub grip_n: f64,
    /// The least that would hold, N; 0 while the hand carries nothing.
    pub needed_n: f64,
    pub slips: usize,
    /// Distance in them, mm.
    pub slipped_mm: f64,
    pub dropped: bool,
}

/// One thing that can be done at the bench: its line, and its name for a person.
pub type Key = (String, String);

#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum Told {
    Truth(Truth),
    Bench(Option<Vec<Key>>),
}

/// Listens until `tell` returns false, and again when the scene is back. Passes on what is done at the bench.
pub fn watch(target: &Target, acts: &Receiver<String>, tell: &mut dyn FnMut(Told) -> bool) {
    loop {
        if let Ok(line) = target.open() {
            acts.try_iter().for_each(drop);
            if !listen(line, acts, tell) || !tell(Told::Bench(None)) {
                return;
            }
        }
        thread::sleep(AGAIN_AFTER);
    }
}

fn listen(line: Line, acts: &Receiver<String>, tell: &mut dyn FnMut(Told) -> bool) -> bool {
    let (mut lines, mut text, mut down) = (BufReader::new(line.up), String::new(), line.down);
    loop {
        match lines.read_line(&mut text) {
            Ok(0) => return true,
            Ok(_) => {
                if serde_json::from_str(&text).is_ok_and(|told| !tell(told)) {
                    return false;
                }
                text.clear();
            }
            Err(error) if is_silence(&error) => {}
            Err(_) => return true,
        }
        let Some(down) = &mut down else { continue };
        if acts.try_iter().any(|act| writeln!(down, "{act}").is_err()) {
            return true;
        }
    }
}
