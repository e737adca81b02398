//! A board's line that may end and begin again: somebody pulls its plug.

use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Answer, DRIVE_HOLD_MAX_MS, Down, Refusal, Up};
use tenax_hal_shim::words::Fault;

use super::super::Say;
use crate::link::{ANSWER_WITHIN, Client};

/// The board streams for so long after it is asked, s; it is asked again in half of it.
const HOLD_S: u16 = 4;
/// How long a line may be gone.
const GONE: Duration = Duration::from_secs(60);
/// How long somebody may take to consent.
const CONSENT: Duration = Duration::from_secs(60);
/// A board that is silent for so long is off: then this computer's time counts.
const SILENT: Duration = Duration::from_secs(1);
/// A drive is asked for again so soon.
const DRIVES: Duration = Duration::from_millis(100);

/// What the board is asked to send beside what it always does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stream {
    pub raw: bool,
    pub senses: bool,
}

pub struct Wire<'a> {
    open: &'a dyn Fn() -> anyhow::Result<Client>,
    pub client: Client,
    asked: Option<(Stream, Instant)>,
    /// Times that it had to be opened again: the board's port went with its power, and what its start said was not heard.
    opened_again: u32,
}

impl<'a> Wire<'a> {
    /// One that is opened so, now and whenever it has ended.
    pub fn new(open: &'a dyn Fn() -> anyhow::Result<Client>) -> anyhow::Result<Self> {
        Ok(Self { open, client: open()?, asked: None, opened_again: 0 })
    }

    /// Hears it for so long, or until `take` has heard enough, which is told. It is the board's time that counts, for one that is served
    /// may be slower than this computer. Fails if the line is gone for a minute.
    pub fn hear(
        &mut self,
        lasts: Duration,
        stream: Stream,
        take: &mut dyn FnMut(Instant, &Up) -> anyhow::Result<bool>,
    ) -> anyhow::Result<bool> {
        let began = Instant::now();
        let (mut passed, mut last, mut heard_at) = (0, None::<u32>, began);
        let lasts_frames = (lasts.as_secs_f64() * f64::from(FRAME_HZ)) as u32;
        while passed < lasts_frames && (heard_at.elapsed() < SILENT || began.elapsed() < lasts) {
            let is_fresh = |(what, at): (Stream, Instant)| {
                what == stream && at.elapsed().as_secs() < u64::from(HOLD_S) / 2
            };
            if stream != Stream::default() && !self.asked.is_some_and(is_fresh) {
                let Stream { raw, senses } = stream;
                // A line that has ended is noticed below.
                let _gone = self.client.send(&Down::Stream { raw, senses, hold_s: HOLD_S });
                self.asked = Some((stream, Instant::now()));
            }
            match self.client.next_message() {
                Ok(Some(heard)) => {
                    match &heard.received.message {
                        Up::Hello { .. } => self.asked = None,
                        Up::Slow(slow) => {
                            // A board that starts anew counts anew.
                            passed += last.map_or(0, |last| slow.frame.saturating_sub(last));
                            (last, heard_at) = (Some(slow.frame), Instant::now());
                        }
                        _ => {}
                    }
                    if take(Instant::now(), &heard.received.message)? {
                        return Ok(true);
                    }
                }
                Ok(None) => {}
                Err(_) => self.open_again()?,
            }
        }
        Ok(false)
    }

    fn open_again(&mut self) -> anyhow::Result<()> {
        let began = Instant::now();
        self.asked = None;
        loop {
            match (self.open)() {
                Ok(client) => {
                    self.client = client;
                    self.opened_again += 1;
                    return Ok(());
                }
                Err(error) if began.elapsed() > GONE => return Err(error).context("the line is gone"),
                Err(_) => thread::sleep(Duration::from_millis(100)),
            }
        }
    }

    /// Waits until `take` has heard what it waits for.
    pub fn wait(
        &mut self,
        within: Duration,
        what: &str,
        stream: Stream,
        take: &mut dyn FnMut(Instant, &Up) -> anyhow::Result<bool>,
    ) -> anyhow::Result<()> {
        if self.hear(within, stream, take)? {
            return Ok(());
        }
        bail!("waited {} s for {what}, in vain", within.as_secs())
    }

    /// Waits for the board to start; why it did, if not because it was switched on. `take` hears what it said before.
    pub fn start(&mut self, within: Duration, take: &mut dyn FnMut(&Up)) -> anyhow::Result<Option<Fault>> {
        let (began, opened, mut why) = (Instant::now(), self.opened_again, None);
        while began.elapsed() < within && self.opened_again == opened {
            let heard = self.hear(Duration::from_millis(200), Stream::default(), &mut |_, message| {
                take(message);
                let Up::Hello { after, .. } = message else { return Ok(false) };
                why = *after;
                Ok(true)
            })?;
            if heard {
                return Ok(why);
            }
        }
        if self.opened_again > opened {
            Ok(None)
        } else {
            bail!("the board does not start in {} s", within.as_secs())
        }
    }

    /// Asks for something that needs consent, and waits for somebody who gives it.
    pub fn ask(&mut self, command: Down, say: Say<'_>) -> anyhow::Result<Answer> {
        let began = Instant::now();
        let mut is_asked = false;
        loop {
            match self.client.ask(&command, ANSWER_WITHIN)? {
                Answer::Refused(Refusal::NotArmed) if began.elapsed() < CONSENT => {
                    if !std::mem::replace(&mut is_asked, true) {
                        say("Press the blue button: the hand has to consent.")?;
                    }
                    self.hear(Duration::from_millis(200), Stream::default(), &mut |_, _| Ok(false))?;
                }
                // It has driven for long enough: as much silence renews it.
                Answer::Refused(Refusal::HeldTooLong) if began.elapsed() < CONSENT => {
                    self.hear(Duration::from_millis(200), Stream::default(), &mut |_, _| Ok(false))?;
                }
                Answer::Refused(refusal) => bail!("the board refuses {command:?}: {refusal:?}"),
                answer => return Ok(answer),
            }
        }
    }

    /// Drives the motor for so long. `take` hears what comes meanwhile; when it has heard enough the drive is not asked for again.
    pub fn drive(
        &mut self,
        drive: MotorDrive,
        lasts: Duration,
        stream: Stream,
        say: Say<'_>,
        take: &mut dyn FnMut(Instant, &Up) -> anyhow::Result<bool>,
    ) -> anyhow::Result<bool> {
        let command = Down::Drive { drive, hold_ms: DRIVE_HOLD_MAX_MS };
        self.ask(command, say)?;
        let mut is_over = false;
        for _ in 0..lasts.as_millis() / DRIVES.as_millis() {
            if is_over {
                break;
            }
            let _gone = self.client.send(&command);
            is_over = self.hear(DRIVES, stream, take)?;
        }
        let _gone = self.client.send(&Down::Drive { drive: MotorDrive::Coast, hold_ms: 0 });
        Ok(is_over)
    }
}
