//! A board's serial line for people: one line a message.

use std::io::{self, Write};

use tenax_frames::link::{Client, Heard};
use tenax_frames::words::{why, words};

/// Prints messages, gaps and bad frames until the line ends; the reason. Fails if it cannot print.
pub fn watch(client: &mut Client, out: &mut dyn Write) -> io::Result<io::Error> {
    loop {
        match client.next_frame() {
            Ok(Some(Ok(Heard { received, missed }))) => {
                if missed > 0 {
                    writeln!(out, "# {missed} messages missed")?;
                }
                writeln!(out, "{:>5} {}", received.sequence, words(&received.message))?;
            }
            Ok(Some(Err(bad))) => writeln!(out, "# frame skipped: {}", why(bad))?,
            Ok(None) => out.flush()?,
            Err(end) => return out.flush().map(|()| end),
        }
    }
}
