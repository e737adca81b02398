//! Both directions of a line: commands are sent, their answers waited for, and every message counted.

use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use tenax_hal_shim::wire::{Answer, BadFrame, Down, Refusal, Up};
use tenax_logic::setting::SettingId;

use super::{Counts, Heard, Inbox, Line, Outbox, Target};

/// How long a board may take to answer.
pub const ANSWER_WITHIN: Duration = Duration::from_secs(2);
/// How often a session is asked for, if somebody else on the line asks for one at the same time.
const SESSIONS_MAX: u32 = 8;

/// The board takes 500 commands a second, and skips what comes faster: a little less than that is sent.
const EACH: Duration = Duration::from_micros(2_500);
/// Commands that one with a long answer counts as.
const LONG: u32 = 6;

pub struct Client {
    up: Box<dyn Read + Send>,
    outbox: Option<Outbox<Box<dyn Write + Send>>>,
    inbox: Inbox,
    heard: VecDeque<Result<Heard, BadFrame>>,
    /// When the next command may be sent.
    free_at: Option<Instant>,
    /// Messages at the front of `heard` that were looked at while an answer was waited for.
    looked_at: usize,
}

impl From<Line> for Client {
    fn from(line: Line) -> Self {
        Self {
            up: line.up,
            outbox: line.down.map(Outbox::new),
            inbox: Inbox::default(),
            heard: VecDeque::new(),
            free_at: None,
            looked_at: 0,
        }
    }
}

impl Client {
    /// One on the line at `target`. Fails as [`Target::open`] does.
    pub fn open(target: &Target) -> anyhow::Result<Self> {
        target.open().map(Self::from)
    }

    pub fn counts(&self) -> Counts {
        self.inbox.counts()
    }

    /// The next message. None while there is none yet, after a tenth of a second at most.
    /// Fails if the line has ended: `UnexpectedEof` where it was closed in order.
    pub fn next_message(&mut self) -> io::Result<Option<Heard>> {
        Ok(self.next_frame()?.and_then(Result::ok))
    }

    /// The next message, or a frame that was none. None while nothing has come. Fails as [`next_message`](Self::next_message) does.
    pub fn next_frame(&mut self) -> io::Result<Option<Result<Heard, BadFrame>>> {
        if self.heard.is_empty() {
            self.read()?;
        }
        self.looked_at = self.looked_at.saturating_sub(1);
        Ok(self.heard.pop_front())
    }

    /// Whether commands can be sent: a captured line takes none.
    pub const fn can_send(&self) -> bool {
        self.outbox.is_some()
    }

    /// Sends a command without waiting; returns its number, which its answer names. Fails if the line is a captured one, or has ended.
    pub fn send(&mut self, command: &Down) -> anyhow::Result<u16> {
        let Some(outbox) = &mut self.outbox else {
            bail!("a captured line cannot be told anything: give a port, or tcp:HOST:PORT");
        };
        let now = Instant::now();
        let free_at = self.free_at.map_or(now, |at| at.max(now));
        thread::sleep(free_at - now);
        self.free_at = Some(free_at + if has_long_answer(command) { EACH * LONG } else { EACH });
        outbox.send(command).context("cannot write to the line")
    }

    /// Sends a command and returns its answer. All messages that come meanwhile, the answer too, are still given by
    /// [`next_message`](Self::next_message). What changes something needs a session: one is opened when the board asks
    /// for it. Fails if there is no answer in `within`, or the line has ended, or is a captured one.
    pub fn ask(&mut self, command: &Down, within: Duration) -> anyhow::Result<Answer> {
        let mut answer = self.ask_once(command, within)?;
        for attempt in 1..=SESSIONS_MAX {
            // Somebody else on the same line may have opened one of their own: then the numbers that count are theirs.
            if !matches!(answer, Answer::Refused(Refusal::NoSession | Refusal::Replayed)) {
                break;
            }
            self.open_session(within)?;
            answer = self.ask_once(command, within)?;
            if matches!(answer, Answer::Refused(Refusal::NoSession | Refusal::Replayed)) {
                // Two who ask in step would void each other's sessions for ever.
                thread::sleep(Duration::from_millis(u64::from(std::process::id() % 31 * attempt)));
            }
        }
        Ok(answer)
    }

    /// A setting's value. Fails as [`ask`](Self::ask) does, or if the board answers something else.
    pub fn setting(&mut self, id: SettingId) -> anyhow::Result<i32> {
        match self.ask(&Down::Get(id.number()), ANSWER_WITHIN)? {
            Answer::Setting(own) => Ok(own.value),
            other => bail!("the board does not say its {}: {other:?}", id.row().name),
        }
    }

    /// Opens a session, without which the board only lets read. False if it refused. Fails as [`ask`](Self::ask) does.
    pub fn open_session(&mut self, within: Duration) -> anyhow::Result<bool> {
        let Answer::Nonce(nonce) = self.ask_once(&Down::Hello, within)? else { return Ok(false) };
        Ok(self.ask_once(&Down::Open { nonce }, within)? == Answer::Done)
    }

    /// The sender, for a thread of its own. Nothing can be asked afterwards.
    pub fn take_outbox(&mut self) -> Option<Outbox<Box<dyn Write + Send>>> {
        self.outbox.take()
    }

    fn ask_once(&mut self, command: &Down, within: Duration) -> anyhow::Result<Answer> {
        // A board that is slower than real time takes fewer commands; the same twice does no more than once.
        let again = command.reads() || matches!(command, Down::Set(_));
        if again && let Some(answer) = self.ask_number(command, within / 2)? {
            return Ok(answer);
        }
        match self.ask_number(command, within)? {
            Some(answer) => Ok(answer),
            None => bail!("no answer in {} s: is this a fingertip's line?", within.as_secs_f64()),
        }
    }

    fn ask_number(&mut self, command: &Down, within: Duration) -> anyhow::Result<Option<Answer>> {
        let number = self.send(command)?;
        let began = Instant::now();
        while began.elapsed() < within {
            while let Some(heard) = self.heard.get(self.looked_at) {
                self.looked_at += 1;
                if let Ok(heard) = heard
                    && let Up::Answer { of, answer, .. } = &heard.received.message
                    && *of == number
                {
                    return Ok(Some(answer.clone()));
                }
            }
            self.read().context("the line ended before the answer came")?;
        }
        Ok(None)
    }

    fn read(&mut self) -> io::Result<()> {
        let mut buffer = [0; 4096];
        match self.up.read(&mut buffer) {
            Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
            Ok(length) => {
                self.heard.extend(buffer[..length].iter().filter_map(|&byte| self.inbox.push(byte)));
                Ok(())
            }
            Err(error) if is_silence(&error) => Ok(()),
            Err(error) => Err(error),
        }
    }
}

/// Whether a command's answer takes a good part of the line, so that the board counts it as several.
const fn has_long_answer(command: &Down) -> bool {
    matches!(command, Down::Samples | Down::Network | Down::Settings(_) | Down::About | Down::Last(_))
}

/// Whether a read failed only because nothing has come yet.
pub fn is_silence(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted)
}
