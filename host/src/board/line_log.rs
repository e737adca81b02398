//! What came up a serial line, made into messages. Nothing on it is trusted.

use tenax_hal_shim::wire::{Received, Receiver, Up};

use super::Run;

/// Puts the messages in `run.line` where they belong in `run`.
pub fn decode(run: &mut Run) {
    let mut receiver = Receiver::new();
    let mut expected = None;
    for &byte in &run.line {
        match receiver.push::<Up>(byte) {
            None => {}
            Some(Err(_)) => run.bad_frames += 1,
            Some(Ok(Received { sequence, message })) => {
                // A board that starts anew counts anew.
                let restarted = matches!(message, Up::Hello { .. });
                if let Some(expected) = expected.filter(|_| !restarted) {
                    run.messages_missed += u64::from(sequence.wrapping_sub(expected));
                }
                expected = Some(sequence.wrapping_add(1));
                match message {
                    Up::Hello { after, .. } => run.starts.push(after),
                    Up::Slow(slow) => run.slows.push(slow),
                    Up::Event(event) => run.events.push(event),
                    Up::Counters(counters) => run.counters = counters,
                    Up::Answer { of, answer, .. } => run.answers.push((of, answer)),
                    Up::Saved { frame, kept } => run.saved.push((frame, kept)),
                }
            }
        }
    }
}
