//! Which command the image took before which tick.

use std::collections::VecDeque;

use tenax_hal_shim::wire::{Answer, Down, Received};

/// What was sent, and when the image took something.
///
/// The line and the image's tasks take their time, so a command is not taken in the tick of the frame in which it was sent:
/// one of the last scan always comes too late for it. When one is taken is seen at the core; which one, by its answer, for
/// commands are taken and answered in one order.
#[derive(Debug, Default)]
pub struct Commands {
    sent: VecDeque<Received<Down>>,
    taken_before: Vec<u32>,
}

impl Commands {
    pub fn send(&mut self, command: Received<Down>) {
        self.sent.push_back(command);
    }

    /// The image takes a command before this tick.
    pub fn take(&mut self, tick: u32) {
        self.taken_before.push(tick);
    }

    /// Each command that was answered, with the sequence number of the frame before whose tick it was taken.
    pub fn taken(mut self, answers: &[(u16, Answer)]) -> Vec<(u32, Received<Down>)> {
        let answered = answers.iter().filter_map(|(of, _)| {
            // What the line swallowed was never answered.
            std::iter::from_fn(|| self.sent.pop_front()).find(|command| command.sequence == *of)
        });
        self.taken_before.iter().copied().zip(answered).collect()
    }
}
