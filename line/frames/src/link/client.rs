//! Both directions of a line: sends commands, waits for their answers, counts messages.

use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use tenax_hal_shim::wire::{Answer, BadFrame, Down, Refusal, Setting, Up};
use tenax_logic::setting::SettingId;

use super::{Counts, Heard, Inbox, Line, Outbox, Target};

pub const ANSWER_WITHIN: Duration = Duration::from_secs(2);
/// Attempts to open a session, if another client of the line opens one at the same time.
const SESSIONS_MAX: u32 = 8;
/// Pause after a command: the board takes 500 a second, and skips the rest.
const EACH: Duration = Duration::from_micros(2_500);
/// Interval at which streams are asked for, each time for twice as long.
const STREAM_EVERY: Duration = Duration::from_secs(2);
/// Commands that one with a long answer counts as.
const LONG: u32 = 6;

pub struct Client {
    up: Box<dyn Read + Send>,
    outbox: Option<Outbox<Box<dyn Write + Send>>>,
    inbox: Inbox,
    heard: VecDeque<Result<Heard, BadFrame>>,
    /// Number of the command whose answer is awaited, and the setting that it names.
    asked: Option<(u16, Option<u8>)>,
    answer: Option<Answer>,
    /// When the next command may be sent.
    free_at: Instant,
    streamed: Option<Instant>,
}

impl From<Line> for Client {
    fn from(line: Line) -> Self {
        Self {
            up: line.up,
            outbox: line.down.map(Outbox::new),
            inbox: Inbox::default(),
            heard: VecDeque::new(),
            asked: None,
            answer: None,
            free_at: Instant::now(),
            streamed: None,
        }
    }
}

impl Client {
    /// Opens the line at `target`. Fails as [`Target::open`] does.
    pub fn open(target: &Target) -> anyhow::Result<Self> {
        target.open().map(Self::from)
    }

    pub fn counts(&self) -> Counts {
        self.inbox.counts()
    }

    /// Goes on from the counts of the client of a line that has ended.
    pub fn count_on(&mut self, before: Counts) {
        self.inbox.count_on(before);
    }

    /// The next message. None if none comes within 0.1 s. Fails if the line has ended: with `UnexpectedEof` if it was closed in order.
    pub fn next_message(&mut self) -> io::Result<Option<Heard>> {
        Ok(self.next_frame()?.and_then(Result::ok))
    }

    /// The next message, or why a frame is none. Otherwise as [`next_message`](Self::next_message).
    pub fn next_frame(&mut self) -> io::Result<Option<Result<Heard, BadFrame>>> {
        if self.heard.is_empty() {
            self.read()?;
        }
        Ok(self.heard.pop_front())
    }

    /// Whether commands can be sent: not to a file.
    pub const fn can_send(&self) -> bool {
        self.outbox.is_some()
    }

    /// Sends a command without waiting; returns its number, which its answer names. Fails if the line is a file, or has ended.
    pub fn send(&mut self, command: &Down) -> anyhow::Result<u16> {
        let Some(outbox) = &mut self.outbox else {
            bail!("a captured line cannot be told anything: give a port, or tcp:HOST:PORT");
        };
        thread::sleep(self.free_at.saturating_duration_since(Instant::now()));
        let is_long = matches!(
            command,
            Down::Samples | Down::Network | Down::Settings(_) | Down::About | Down::Last(_)
        );
        self.free_at = Instant::now() + if is_long { EACH * LONG } else { EACH };
        outbox.send(command).context("cannot write to the line")
    }

    /// Asks the board to stream its readings, and its frames too if `raw`, each time that half of the time before is over.
    pub fn keep_streaming(&mut self, raw: bool) -> anyhow::Result<()> {
        if self.can_send() && self.streamed.is_none_or(|at| at.elapsed() >= STREAM_EVERY) {
            let hold_s = 2 * STREAM_EVERY.as_secs() as u16;
            self.send(&Down::Stream { raw, senses: true, hold_s })?;
            self.streamed = Some(Instant::now());
        }
        Ok(())
    }

    /// Sends a command and returns its answer. All messages that come meanwhile, the answer too, are still given by
    /// [`next_message`](Self::next_message). A session is opened when the board asks for one.
    /// Fails if there is no answer in `within`, or as [`send`](Self::send) does.
    pub fn ask(&mut self, command: &Down, within: Duration) -> anyhow::Result<Answer> {
        let mut answer = self.ask_once(command, within)?;
        for attempt in 1..=SESSIONS_MAX {
            // Another client of the line may have opened a session: then only its numbers count.
            if !matches!(answer, Answer::Refused(Refusal::NoSession | Refusal::Replayed)) {
                break;
            }
            // Two clients in step would void each other's sessions for ever.
            let pause = if attempt > 1 { std::process::id() % 31 * attempt } else { 0 };
            thread::sleep(Duration::from_millis(pause.into()));
            self.open_session(within)?;
            answer = self.ask_once(command, within)?;
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

    /// Opens a session, without which the board only answers reading commands. False: it refused. Fails as [`ask`](Self::ask) does.
    pub fn open_session(&mut self, within: Duration) -> anyhow::Result<bool> {
        let Answer::Nonce(nonce) = self.ask_once(&Down::Hello, within)? else { return Ok(false) };
        Ok(self.ask_once(&Down::Open { nonce }, within)? == Answer::Done)
    }

    fn ask_once(&mut self, command: &Down, within: Duration) -> anyhow::Result<Answer> {
        // A board that is slower than real time skips more commands. Twice the same read or `Set` does no more than one.
        let repeats = command.reads() || matches!(command, Down::Set(_));
        for wait in repeats.then_some(within / 2).into_iter().chain([within]) {
            let named = match command {
                Down::Get(id) => Some(*id),
                Down::Set(setting) => Some(setting.id),
                _ => None,
            };
            self.asked = Some((self.send(command)?, named));
            let began = Instant::now();
            while began.elapsed() < wait {
                self.read().context("the line ended before the answer came")?;
                if let Some(answer) = self.answer.take() {
                    return Ok(answer);
                }
            }
        }
        bail!("no answer in {} s: is this a fingertip's line?", within.as_secs_f64())
    }

    fn read(&mut self) -> io::Result<()> {
        let mut buffer = [0; 4096];
        let length = match self.up.read(&mut buffer) {
            Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
            Ok(length) => length,
            Err(error) if is_silence(&error) => return Ok(()),
            Err(error) => return Err(error),
        };
        for frame in buffer[..length].iter().filter_map(|&byte| self.inbox.push(byte)) {
            if let Ok(heard) = &frame
                && let Up::Answer { of, answer, .. } = &heard.received.message
                && self.asked.take_if(|asked| answers(*asked, *of, answer)).is_some()
            {
                self.answer = Some(answer.clone());
            }
            self.heard.push_back(frame);
        }
        Ok(())
    }
}

pub fn is_silence(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted)
}

/// Two clients' numbers may meet; then the setting tells their answers apart.
fn answers((number, named): (u16, Option<u8>), of: u16, answer: &Answer) -> bool {
    let fits = |setting: &Setting| named.is_none_or(|named| named == setting.id);
    number == of && !matches!(answer, Answer::Setting(setting) if !fits(setting))
}
