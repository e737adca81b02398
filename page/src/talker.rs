//! The page's end of a board's line: messages go into a view, commands are asked one after the other, a session is opened when the board
//! wants one.

use std::collections::VecDeque;

use tenax_frames::link::{Encoder, Inbox};
use tenax_frames::words::answer_words;
use tenax_hal_shim::wire::{Answer, Down, Refusal, Up};
use tenax_line::view::View;

const ANSWER_WITHIN_S: f64 = 4.0;
/// Times that a command is sent which does no more twice than once: a board that is slow skips some.
const TRIES: usize = 2;
/// Readings stream for twice as long as until they are asked for again.
const STREAM_EVERY_S: f64 = 5.0;
const SESSIONS_MAX: u32 = 4;

/// A command whose answer is waited for: the numbers under which it was sent, and when it was last, s.
struct Asked {
    numbers: Vec<u16>,
    at_s: f64,
    command: Down,
}

#[derive(Default)]
pub struct Talker {
    pub view: View,
    inbox: Inbox,
    encoder: Encoder,
    asked: Option<Asked>,
    waiting: VecDeque<Down>,
    sessions: u32,
    streamed_s: Option<f64>,
    out: Vec<u8>,
}

impl Talker {
    pub fn ask(&mut self, command: Down) {
        self.waiting.push_back(command);
    }

    /// Takes the line's bytes at this time, s; the bytes that go down.
    pub fn go_on(&mut self, bytes: &[u8], now_s: f64) -> Vec<u8> {
        for &byte in bytes {
            let Some(frame) = self.inbox.push(byte) else { continue };
            self.view.frame(frame.as_ref().map_err(|bad| *bad), self.inbox.counts());
            if let Ok(heard) = &frame
                && let Up::Answer { of, answer, .. } = &heard.received.message
                && let Some(asked) = self.asked.take_if(|asked| asked.numbers.contains(of))
            {
                self.answered(asked.command, answer, now_s);
            }
        }
        if let Some(Asked { numbers, command, .. }) =
            self.asked.take_if(|asked| now_s - asked.at_s > ANSWER_WITHIN_S)
        {
            let repeats = command.reads() || matches!(command, Down::Set(_) | Down::Hello);
            if repeats && numbers.len() < TRIES {
                self.put(command, now_s, numbers);
            } else {
                self.view.say(&format!("> {command:?}: no answer"));
            }
        }
        if self.streamed_s.is_none_or(|at_s| now_s - at_s >= STREAM_EVERY_S) {
            let hold_s = 2 * STREAM_EVERY_S as u16;
            self.send(&Down::Stream { raw: false, senses: true, hold_s });
            self.streamed_s = Some(now_s);
        }
        if self.asked.is_none()
            && let Some(command) = self.waiting.pop_front()
        {
            self.put(command, now_s, Vec::new());
        }
        std::mem::take(&mut self.out)
    }

    fn answered(&mut self, command: Down, answer: &Answer, now_s: f64) {
        match answer {
            Answer::Refused(Refusal::NoSession | Refusal::Replayed) if self.sessions < SESSIONS_MAX => {
                self.sessions += 1;
                self.waiting.push_front(command);
                self.put(Down::Hello, now_s, Vec::new());
            }
            Answer::Nonce(nonce) => self.put(Down::Open { nonce: *nonce }, now_s, Vec::new()),
            _ if matches!(command, Down::Open { .. } | Down::About | Down::Last(_)) => {}
            _ => {
                self.sessions = 0;
                self.view.say(&format!("> {}", answer_words(&command, answer)));
            }
        }
    }

    fn put(&mut self, command: Down, at_s: f64, mut numbers: Vec<u16>) {
        numbers.push(self.send(&command));
        self.asked = Some(Asked { numbers, at_s, command });
    }

    fn send(&mut self, command: &Down) -> u16 {
        let (number, frame) = self.encoder.frame(command);
        self.out.extend_from_slice(frame);
        number
    }
}
