//! What a person or their camera sends down a board's serial line.

use std::io::{self, BufRead, Write};

use anyhow::{Context, bail};
use tenax_hal_shim::wire::Down;
use tenax_hal_shim::words::Code;

use super::Encoder;

/// Numbers commands and writes them as frames.
#[derive(Debug)]
pub struct Outbox<W> {
    line: W,
    encoder: Encoder,
}

impl<W: Write> Outbox<W> {
    pub fn new(line: W) -> Self {
        Self { line, encoder: Encoder::default() }
    }

    /// Sends one command; returns its number, which its answer names.
    pub fn send(&mut self, command: &Down) -> io::Result<u16> {
        let (number, frame) = self.encoder.frame(command);
        self.line.write_all(frame)?;
        self.line.flush()?;
        Ok(number)
    }

    /// Sends a camera's words as they come, a line each: `v1 v2 [age_ms]`, until there are no more.
    /// An error names the line that is none, and says what one looks like.
    pub fn teach(&mut self, words: impl BufRead) -> anyhow::Result<()> {
        for (number, line) in (1..).zip(words.lines()) {
            let line = line.context("cannot read the teacher's words")?;
            let text = line.trim();
            if text.is_empty() || text.starts_with('#') {
                continue;
            }
            let command = teaching(text).with_context(|| {
                format!(
                    "line {number} of the teacher: `{text}` is no `v1 v2 [age_ms]`, such as `-1 1 40`: it slips, the \
                     hand moves up, and the picture is 40 ms old"
                )
            })?;
            self.send(&command).context("cannot write to the port")?;
        }
        Ok(())
    }
}

/// Age of a picture whose age nobody says, ms: one frame of 30 Hz.
const AGE_MS: u16 = 33;

fn teaching(text: &str) -> anyhow::Result<Down> {
    let numbers: Vec<&str> = text.split([' ', ',', '\t']).filter(|number| !number.is_empty()).collect();
    let (v1, v2, age) = match numbers[..] {
        [v1, v2] => (v1, v2, None),
        [v1, v2, age] => (v1, v2, Some(age)),
        _ => bail!("{} numbers", numbers.len()),
    };
    let code = |number: &str| match number {
        "-1" => Ok(Code::Minus),
        "0" => Ok(Code::Zero),
        "1" | "+1" => Ok(Code::Plus),
        other => bail!("{other} is not -1, 0 or 1"),
    };
    let age_ms =
        age.map_or(Ok(AGE_MS), |age| age.parse().with_context(|| format!("{age} is no age in ms")))?;
    Ok(Down::Teach { codes: [code(v1)?, code(v2)?], age_ms })
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_hal_shim::wire::Receiver;

    #[test]
    fn a_cameras_words_arrive_in_order() {
        let mut line = Vec::new();
        let words = "# v1 v2 age\n-1 1 40\n\n1,+1\n0 -1 12\n";
        Outbox::new(&mut line).teach(words.as_bytes()).unwrap();
        let mut receiver = Receiver::new();
        let heard: Vec<_> =
            line.iter().filter_map(|&byte| receiver.push::<Down>(byte)).map(Result::unwrap).collect();
        let teach = |v1, v2, age_ms| Down::Teach { codes: [v1, v2], age_ms };
        let expected = [
            teach(Code::Minus, Code::Plus, 40),
            teach(Code::Plus, Code::Plus, AGE_MS),
            teach(Code::Zero, Code::Minus, 12),
        ];
        assert_eq!(heard.iter().map(|received| received.message).collect::<Vec<_>>(), expected);
        assert_eq!(heard.iter().map(|received| received.sequence).collect::<Vec<_>>(), [0, 1, 2]);
    }

    #[test]
    fn a_line_that_is_no_word_is_named() {
        for wrong in ["-1", "2 0", "1 1 soon", "1 1 70000", "1 1 1 1"] {
            let error = Outbox::new(Vec::new()).teach(format!("1 1\n{wrong}\n").as_bytes()).unwrap_err();
            assert!(format!("{error:#}").contains(&format!("line 2 of the teacher: `{wrong}`")), "{error:#}");
        }
    }
}
