//! A source's pictures in time: as fast as they are decoded, or as a camera's would come, which a board can be told of.
//!
//! A drawn camera can be broken for a while, so that what becomes of a hand that feels with it is seen beforehand.

use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use tenax_vision::frame::FRAME_BYTES;
use tenax_vision::quality::LOST_MS;

use super::source::{Pictures, Source};

pub type Planes = Box<[u8; FRAME_BYTES]>;

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Fault {
    /// No picture comes.
    Lost,
    /// Dark pictures.
    Covered,
    /// One picture again and again.
    Frozen,
    /// They come 200 ms after they were taken.
    Late,
}

/// When it is wrong, s of the story: an object is held meanwhile, and slides.
const FAULT_S: std::ops::Range<f64> = 4.0..6.0;
/// Delay of a late picture, ms.
const LATE_MS: f64 = 200.0;
/// Pictures of a drawn scene that are kept at most: 70 MB of them are 10 s.
const DRAWN_MAX: usize = 1_000;
/// A covered lens lets this much through.
const DARK: u8 = 3;

#[derive(Debug)]
pub enum Next {
    /// A picture, with the instants at which it was taken and came, ms.
    Picture(Planes, u32, u32),
    Silence(u32),
    End,
}

/// A picture on its way.
struct Sent {
    planes: Planes,
    taken_ms: f64,
    due_ms: f64,
}

pub struct Feed {
    sent: Receiver<Result<Sent>>,
    /// Whether it goes on in real time, and since when.
    live: bool,
    clock: Option<Instant>,
    /// A device's pictures come when they are taken, as far as anybody knows.
    by_arrival: bool,
    last_ms: f64,
    waiting: Option<Sent>,
    silent: bool,
}

impl Feed {
    /// Opens a source of so many pictures a second. In real time if it is `live`, from the first picture that is asked for; what is
    /// drawn is drawn before. Fails if it cannot be opened.
    pub fn open(source: &Source, rate_hz: f64, fault: Option<Fault>, live: bool) -> Result<Self> {
        let mut pictures = source.open()?;
        let by_arrival = matches!(source, Source::Device(_));
        let drawn_first = live && matches!(source, Source::Drawn { .. });
        let (out, sent) = sync_channel(if drawn_first { DRAWN_MAX } else { 2 });
        let reader = thread::spawn(move || {
            let mut frozen: Option<Planes> = None;
            for number in 0.. {
                let taken_ms = f64::from(number) * 1e3 / rate_hz;
                let is_wrong = FAULT_S.contains(&(taken_ms / 1e3));
                let mut planes = match read(&mut pictures) {
                    Ok(Some(planes)) => planes,
                    Ok(None) => return,
                    Err(error) => return drop(out.send(Err(error))),
                };
                let mut due_ms = taken_ms;
                match fault.filter(|_| is_wrong) {
                    None => frozen = None,
                    Some(Fault::Lost) => continue,
                    // A sensor in the dark still has its noise.
                    Some(Fault::Covered) => planes.iter_mut().for_each(|level| *level = *level / 16 + DARK),
                    Some(Fault::Frozen) => planes = frozen.get_or_insert(planes).clone(),
                    Some(Fault::Late) => due_ms += LATE_MS,
                }
                // Nobody wants any more.
                if out.send(Ok(Sent { planes, taken_ms, due_ms })).is_err() {
                    return;
                }
            }
        });
        if drawn_first && reader.join().is_err() {
            bail!("the scene cannot be drawn");
        }
        Ok(Self { sent, live, clock: None, by_arrival, last_ms: 0.0, waiting: None, silent: false })
    }

    /// The next picture or silence. Fails if a picture could not be read.
    pub fn take(&mut self) -> Result<Next> {
        self.clock = self.clock.or_else(|| self.live.then(Instant::now));
        let sent = match self.waiting.take() {
            Some(sent) => sent,
            None => match self.receive()? {
                Ok(sent) => sent,
                Err(next) => return Ok(next),
            },
        };
        // A gap between two pictures is noticed while it lasts.
        let lost_ms = self.last_ms + f64::from(LOST_MS);
        if !self.silent && !self.by_arrival && sent.due_ms > lost_ms {
            self.waiting = Some(sent);
            self.silent = true;
            self.wait_until(lost_ms);
            return Ok(Next::Silence(lost_ms as u32));
        }
        self.silent = false;
        if !self.by_arrival {
            self.wait_until(sent.due_ms);
        }
        let now_ms = self.clock.map_or(sent.due_ms, |clock| clock.elapsed().as_secs_f64() * 1e3);
        // What is behind its time is no gap earlier: the camera counts from when it was shown the picture.
        self.last_ms = now_ms;
        let taken_ms = if self.by_arrival { now_ms } else { sent.taken_ms };
        Ok(Next::Picture(sent.planes, taken_ms as u32, now_ms as u32))
    }

    /// The next picture that was read, or that there is none.
    fn receive(&mut self) -> Result<std::result::Result<Sent, Next>> {
        let Some(clock) = self.clock.filter(|_| !self.silent) else {
            return self.sent.recv().map_or(Ok(Err(Next::End)), |sent| sent.map(Ok));
        };
        match self.sent.recv_timeout(Duration::from_millis(LOST_MS.into())) {
            Ok(sent) => sent.map(Ok),
            Err(RecvTimeoutError::Disconnected) => Ok(Err(Next::End)),
            Err(RecvTimeoutError::Timeout) => {
                self.silent = true;
                Ok(Err(Next::Silence(clock.elapsed().as_millis() as u32)))
            }
        }
    }

    fn wait_until(&self, ms: f64) {
        if let Some(clock) = self.clock {
            thread::sleep(Duration::from_secs_f64(ms / 1e3).saturating_sub(clock.elapsed()));
        }
    }
}

fn read(pictures: &mut Pictures) -> Result<Option<Planes>> {
    let mut planes: Planes = vec![0; FRAME_BYTES].try_into().ok().context("a picture's size")?;
    Ok(pictures.next(&mut planes)?.then_some(planes))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// When pictures come and how old they are, between two instants; and the silences.
    fn story(fault: Option<Fault>) -> (Vec<(u32, u32)>, Vec<u32>) {
        let mut feed = Feed::open(&Source::Drawn { seed: 1, rate_hz: 30 }, 30.0, fault, false).unwrap();
        let (mut pictures, mut silences) = (Vec::new(), Vec::new());
        loop {
            match feed.take().unwrap() {
                Next::Picture(_, taken_ms, now_ms) => pictures.push((now_ms, now_ms - taken_ms)),
                Next::Silence(now_ms) => silences.push(now_ms),
                Next::End => return (pictures, silences),
            }
        }
    }

    #[test]
    fn a_lost_camera_is_noticed_while_it_is_lost_and_a_late_one_is_late() {
        let (whole, none) = story(None);
        assert_eq!((whole.len(), none.len()), (300, 0));
        assert!(whole.iter().all(|&(_, age_ms)| age_ms == 0));
        let (lost, silences) = story(Some(Fault::Lost));
        assert_eq!((lost.len(), silences.len()), (240, 1));
        assert!((4_160..4_180).contains(&silences[0]), "{silences:?}");
        let (late, _) = story(Some(Fault::Late));
        let old = late.iter().filter(|&&(_, age_ms)| (199..=201).contains(&age_ms)).count();
        assert_eq!((late.len(), old), (300, 60));
    }
}
