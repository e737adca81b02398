//! A board's serial line for people: one line a message, what is missing counted, whatever comes.

pub mod source;
pub mod view;

use std::io::{self, Write};

use tenax_hal_shim::wire::BadFrame;

use tenax_frames::link::{Client, Heard};
use tenax_frames::words::{Words, why};

/// Prints what comes until the line ends; how it ended. Fails if it cannot be printed.
pub fn watch(client: &mut Client, out: &mut dyn Write) -> io::Result<io::Error> {
    loop {
        match client.next_frame() {
            Ok(Some(frame)) => print(&frame, out)?,
            // Nothing more has come so far.
            Ok(None) => out.flush()?,
            Err(end) => return out.flush().map(|()| end),
        }
    }
}

/// Prints a message and what is missing before it, or why a frame is none.
fn print(frame: &Result<Heard, BadFrame>, out: &mut dyn Write) -> io::Result<()> {
    match frame {
        Ok(Heard { received, missed }) => {
            if *missed > 0 {
                writeln!(out, "# {missed} messages missed")?;
            }
            writeln!(out, "{:>5} {}", received.sequence, Words(&received.message))
        }
        Err(bad) => writeln!(out, "# frame skipped: {}", why(*bad)),
    }
}
