//! A palm's board, from a PC: which fingers its hand has, and what happens on its bus.

use std::collections::VecDeque;
use std::fmt;
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context, bail, ensure};
use serde::{Deserialize, Serialize};
use tenax_hal_shim::wire::Receiver;
use tenax_palm::bus::{Chip, FINGERS_MAX};
use tenax_palm::line::{Down, Up};
use tenax_palm::palm::Report;
use tenax_palm::places::{Place, Places};

use crate::link::{Line, Target, behind, is_silence};

/// A palm that keeps other fingers erases a sector of its flash first: 2 s.
const KEEPS_WITHIN: Duration = Duration::from_secs(5);
const ANSWERS_WITHIN: Duration = Duration::from_secs(2);

/// The fingers of a hand, as a file has them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct HandFile {
    finger: Vec<FingerRow>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FingerRow {
    /// The chip's number: three words in hexadecimal.
    chip: String,
    /// Where it stands around the object. It presses the other way.
    at_deg: f64,
    /// The most that it may press.
    ceiling_n: f64,
}

/// The places in a file. An error says which finger is wrong, and what one looks like.
pub fn read(path: &Path) -> anyhow::Result<Places> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    parse(&text).with_context(|| path.display().to_string())
}

fn parse(text: &str) -> anyhow::Result<Places> {
    let HandFile { finger } = toml::from_str(text)?;
    ensure!(finger.len() <= FINGERS_MAX, "{} fingers; a palm has {FINGERS_MAX} at most", finger.len());
    let mut places = Places::new();
    for (row, n) in finger.iter().zip(1..) {
        let place = place(row).with_context(|| format!("finger {n}"))?;
        if let Some(before) = places.iter().position(|own| own.chip == place.chip) {
            bail!("finger {n} has the chip of finger {}", before + 1);
        }
        let _fits = places.push(place);
    }
    Ok(places)
}

fn place(row: &FingerRow) -> anyhow::Result<Place> {
    let words: Option<Vec<u32>> =
        row.chip.split('-').map(|word| u32::from_str_radix(word, 16).ok()).collect();
    let chip = words.and_then(|words| Chip::try_from(words).ok());
    let chip = chip.with_context(|| {
        format!("`{}` is no chip, such as 0030002c-31365105-33393536, which `tenax palm` prints", row.chip)
    })?;
    ensure!((-360.0..=360.0).contains(&row.at_deg), "at_deg = {} is no direction", row.at_deg);
    ensure!((0.0..=100.0).contains(&row.ceiling_n), "ceiling_n = {}: 0 to 100", row.ceiling_n);
    let (sin, cos) = row.at_deg.to_radians().sin_cos();
    let normal = [-cos, -sin].map(|part| (part * 1e3).round() as i16);
    Ok(Place { chip, normal, ceiling_mn: (row.ceiling_n * 1e3).round() as i32 })
}

/// The same as a file: what [`read`] reads.
pub fn file_of(places: &Places) -> String {
    let finger = places.iter().map(|place| {
        let [x, y] = place.normal.map(|part| -f64::from(part));
        FingerRow {
            chip: chip_in_words(place.chip),
            at_deg: y.atan2(x).to_degrees().round() + 0.0,
            ceiling_n: f64::from(place.ceiling_mn) / 1e3,
        }
    });
    toml::to_string(&HandFile { finger: finger.collect() }).expect("rows of numbers and words")
}

fn chip_in_words([a, b, c]: Chip) -> String {
    format!("{a:08x}-{b:08x}-{c:08x}")
}

/// What happened on the bus, in words.
pub struct Told(pub Report);

impl fmt::Display for Told {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Report::Found(finger) => write!(f, "finger {finger} answers"),
            Report::Lost(finger) => write!(f, "finger {finger} is lost"),
            Report::Cut(finger) => write!(f, "finger {finger} speaks without being asked: ignored for 1 s"),
            Report::BusLost => f.write_str("no finger answers: is the bus connected?"),
            Report::Noise => f.write_str("noise on the bus"),
            Report::Stranger(chip) => write!(f, "chip {} is no finger of this hand", chip_in_words(chip)),
        }
    }
}

/// A palm on a line.
pub struct Palm {
    line: Line,
    receiver: Receiver,
    heard: VecDeque<Up>,
    number: u16,
}

impl Palm {
    /// Fails as [`Target::open`] does.
    pub fn open(target: &Target) -> anyhow::Result<Self> {
        Ok(Self::from(target.open_palm()?))
    }

    /// The fingers that its hand has. Fails if it does not answer.
    pub fn hand(&mut self) -> anyhow::Result<Places> {
        match self.ask(&Down::Ask, ANSWERS_WITHIN)? {
            Up::Hand(places) => Ok(places),
            other => bail!("the palm answers {other:?}"),
        }
    }

    /// Has it keep other fingers. Fails if it refuses, or does not answer.
    pub fn keep(&mut self, places: &Places) -> anyhow::Result<()> {
        match self.ask(&Down::Keep(places.clone()), KEEPS_WITHIN)? {
            Up::Hand(kept) if kept == *places => Ok(()),
            Up::Refused => {
                bail!("the palm refuses: a finger holds something (open the hand first), or its flash failed")
            }
            other => bail!("the palm answers {other:?}"),
        }
    }

    /// The next report. None while there is none, after a tenth of a second at most. Fails if the line has ended.
    pub fn report(&mut self) -> anyhow::Result<Option<Report>> {
        let next = self.next()?;
        Ok(if let Some(Up::Bus(report)) = next { Some(report) } else { None })
    }

    fn ask(&mut self, down: &Down, within: Duration) -> anyhow::Result<Up> {
        let Some(line) = &mut self.line.down else { bail!("a captured line cannot be told anything") };
        // A zero ends whatever somebody else has left on the line.
        line.write_all(&[&[0], behind::frame(self.number, down).as_slice()].concat())?;
        line.flush()?;
        self.number = self.number.wrapping_add(1);
        let began = Instant::now();
        while began.elapsed() < within {
            if let Some(answer @ (Up::Hand(_) | Up::Refused)) = self.next()? {
                return Ok(answer);
            }
        }
        bail!("no answer in {} s: is this a palm's line?", within.as_secs())
    }

    fn next(&mut self) -> anyhow::Result<Option<Up>> {
        if let Some(heard) = self.heard.pop_front() {
            return Ok(Some(heard));
        }
        let mut bytes = [0; 4096];
        let length = match self.line.up.read(&mut bytes) {
            Ok(0) => return Err(io::Error::from(ErrorKind::UnexpectedEof).into()),
            Ok(length) => length,
            Err(error) if is_silence(&error) => 0,
            Err(error) => return Err(error.into()),
        };
        for &byte in &bytes[..length] {
            if let Some(Ok(heard)) = self.receiver.push::<Up>(byte) {
                self.heard.push_back(heard.message);
            }
        }
        Ok(self.heard.pop_front())
    }
}

impl From<Line> for Palm {
    fn from(line: Line) -> Self {
        Self { line, receiver: Receiver::new(), heard: VecDeque::new(), number: 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;
    use std::net::{TcpListener, TcpStream};
    use tenax_hal_shim::wire::encode;
    use tenax_palm::bus::{Packet, Word};
    use tenax_palm::line::{self, FRAME_UP_MAX, Lines};

    #[test]
    fn a_hand_is_read_and_what_is_wrong_is_named() {
        let finger =
            |chip: &str, at: f64| format!("[[finger]]\nchip = \"{chip}\"\nat_deg = {at}\nceiling_n = 40\n");
        let hand = finger("30002c-31365105-33393536", 0.0) + &finger("1-2-3", 120.0);
        let places = parse(&hand).unwrap();
        assert_eq!(places[0].normal, [-1_000, 0]);
        assert_eq!(places[1], Place { chip: [1, 2, 3], normal: [500, -866], ceiling_mn: 40_000 });
        assert_eq!(parse(&file_of(&places)).unwrap(), places);

        let error = |text: &str| format!("{:#}", parse(text).unwrap_err());
        assert!(error(&finger("1-2", 0.0)).contains("finger 1: `1-2` is no chip, such as"));
        assert!(error(&(hand.clone() + &finger("1-2-3", 0.0))).contains("finger 3 has the chip of finger 2"));
        assert!(error(&finger("1-2-3", 1e3)).contains("at_deg = 1000 is no direction"));
        let six: String = (0..6).map(|n| finger(&format!("1-2-{n}"), 0.0)).collect();
        assert!(error(&six).contains("6 fingers; a palm has 5 at most"));
        assert!(error("[[finger]]\nchip = \"1-2-3\"\n").contains("missing field `at_deg`"));
    }

    /// A palm's board as far as its line goes, with a finger that has no place.
    fn board() -> Line {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let near = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let (mut far, _) = listener.accept().unwrap();
        std::thread::spawn(move || {
            let (mut palm, mut lines) = (tenax_palm::palm::Palm::new(&[], 0), Lines::default());
            let here = Packet { address: 0, word: Word::Here { chip: [1, 2, 3], nonce: 7 } };
            let mut frame = [0; 64];
            let here = encode(1, &here, &mut frame).unwrap();
            here.iter().for_each(|&byte| _ = palm.hear(byte, 0));
            let (mut byte, mut out) = ([0], [0; FRAME_UP_MAX]);
            while far.read_exact(&mut byte).is_ok() {
                if let Some(places) = lines.hear(byte[0], &mut palm) {
                    palm = tenax_palm::palm::Palm::new(&places, 0);
                    lines.answer(line::Answer::Hand);
                }
                let length = lines.next(&mut palm, &mut out);
                far.write_all(&out[..length]).unwrap();
            }
        });
        near.set_read_timeout(Some(Duration::from_millis(100))).unwrap();
        Line { up: Box::new(near.try_clone().unwrap()), down: Some(Box::new(near)) }
    }

    #[test]
    fn a_palm_says_who_is_there_and_keeps_who_is_named() {
        let mut palm = Palm::from(board());
        assert_eq!(palm.hand().unwrap(), Places::new());
        let places = parse("[[finger]]\nchip = \"1-2-3\"\nat_deg = 90\nceiling_n = 20\n").unwrap();
        palm.keep(&places).unwrap();
        assert_eq!(palm.hand().unwrap(), places);
    }

    #[test]
    fn reports_are_told_in_words() {
        let mut palm = Palm::from(board());
        // Whatever comes makes the board look at what it has to say.
        palm.line.down.as_mut().unwrap().write_all(&[0]).unwrap();
        let report = std::iter::repeat_with(|| palm.report().unwrap()).take(20).flatten().next().unwrap();
        assert_eq!(Told(report).to_string(), "chip 00000001-00000002-00000003 is no finger of this hand");
    }
}
