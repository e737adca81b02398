//! The seconds before a fault that a board keeps, fetched piece by piece.

use anyhow::{bail, ensure};
use tenax_hal_shim::wire::{Answer, Down};
use tenax_hal_shim::words::Fault;

use super::{ANSWER_WITHIN, Client, Inbox};

#[derive(Clone, Debug)]
pub struct LastSeconds {
    pub after: Fault,
    /// Place or message, if the image knew it; else empty.
    pub why: String,
    /// The line's bytes, from a whole frame on.
    pub line: Vec<u8>,
}

impl LastSeconds {
    /// Fetches it. None: the board keeps nothing. Fails if the board does not answer, or answers something else.
    pub fn fetch(client: &mut Client) -> anyhow::Result<Option<Self>> {
        let mut line = Vec::new();
        loop {
            let answer = client.ask(&Down::Last(line.len() as u16), ANSWER_WITHIN)?;
            let Answer::Last(piece) = answer else { bail!("the board answers {answer:?}") };
            let Some(after) = piece.after else {
                ensure!(line.is_empty(), "somebody else has fetched it in the meantime");
                return Ok(None);
            };
            ensure!(
                usize::from(piece.from) == line.len() && !piece.bytes.is_empty(),
                "the board gives piece {} of {} bytes",
                piece.from,
                piece.length
            );
            line.extend(&piece.bytes);
            if line.len() >= usize::from(piece.length) {
                let why = String::from_utf8_lossy(&piece.why).into_owned();
                return Ok(Some(Self { after, why, line: whole(line) }));
            }
        }
    }

    /// Lets the board overwrite them. Fails if the board does not answer.
    pub fn let_go(client: &mut Client) -> anyhow::Result<()> {
        client.ask(&Down::Last(u16::MAX), ANSWER_WITHIN).map(drop)
    }
}

/// Without the rest of a frame whose beginning was overwritten.
fn whole(mut line: Vec<u8>) -> Vec<u8> {
    let mut inbox = Inbox::default();
    if let Some(end) = line.iter().position(|&byte| byte == 0)
        && line[..=end].iter().filter_map(|&byte| inbox.push(byte)).flatten().next().is_none()
    {
        line.drain(..=end);
    }
    line
}
