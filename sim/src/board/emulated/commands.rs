//! Which command the image took before which tick.

use std::collections::VecDeque;

use tenax_hal_shim::wire::{Answer, Down, Received};

#[derive(Debug, Default)]
pub struct Commands {
    sent: VecDeque<Received<Down>>,
    taken_before: Vec<u32>,
}

impl Commands {
    pub fn send(&mut self, command: Received<Down>) {
        self.sent.push_back(command);
    }

    pub fn take(&mut self, tick: u32) {
        self.taken_before.push(tick);
    }

    pub fn taken(mut self, answers: &[(u16, Answer)]) -> Vec<(u32, Received<Down>)> {
        let answered = answers.iter().filter_map(|(of, _)| {
            // What the line swallowed was never answered.
            std::iter::from_fn(|| self.sent.pop_front()).find(|command| command.sequence == *of)
        });
        self.taken_before.iter().copied().zip(answered).collect()
    }
}
