//! What a plant is put into while its board's line is served: real time goes by, and clients' bytes come down.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use tenax_hal_shim::channel::SCAN_HZ;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::BAUD;
use tenax_hal_shim::words::Kept;
use tenax_scene::Act;
use tenax_scene::plant::{Pins, Plant};

use tenax_frames::serve::Down;

const LAG_MAX: Duration = Duration::from_millis(100);
/// Scans between two looks at the clock: 1 ms.
const LOOK_SCANS: u64 = 8;
const BITS_PER_BYTE: u32 = 10;
/// What a command counts as at least, 2.5 ms: a board takes 500 a second and skips the rest, of all clients together.
const COMMAND_BYTES: usize = (BAUD / BITS_PER_BYTE / 400) as usize;
const PRESSED: Duration = Duration::from_millis(300);

pub struct Live {
    pub down: Down,
    /// What the real line could have carried by now and did not, in bytes times [`SCAN_HZ`]: below 0 it is busy.
    room: i64,
    pace: Pace,
    person: Person,
}

#[derive(Clone, Default)]
pub struct Person(Arc<Mutex<Hands>>);

#[derive(Default)]
struct Hands {
    pressed: Option<Instant>,
    acts: VecDeque<Act>,
    flash: Vec<(Kept, Vec<u8>)>,
    resets: bool,
}

impl Person {
    pub fn press(&self) {
        self.hands().pressed = Some(Instant::now());
    }

    pub fn act(&self, act: Act) {
        self.hands().acts.push_back(act);
    }

    pub fn reset(&self) {
        self.hands().resets = true;
    }

    pub fn lets_go(&self) -> bool {
        std::mem::take(&mut self.hands().resets)
    }

    fn hands(&self) -> MutexGuard<'_, Hands> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn is_pressing(&self) -> bool {
        self.hands().pressed.is_some_and(|at| at.elapsed() < PRESSED)
    }
}

impl Live {
    pub fn new(down: Down, person: Person) -> Self {
        Self { down, room: 0, pace: Pace::default(), person }
    }

    fn bytes(&mut self) -> Vec<u8> {
        let scan = i64::from(BAUD / BITS_PER_BYTE);
        self.room = (self.room + scan).min(scan);
        if self.room < 0 {
            return Vec::new();
        }
        let sent = self.down.lock().unwrap_or_else(PoisonError::into_inner).try_recv();
        let bytes = sent.unwrap_or_default();
        let counted = if bytes.is_empty() { 0 } else { bytes.len().max(COMMAND_BYTES) };
        self.room -= counted as i64 * i64::from(SCAN_HZ);
        bytes
    }
}

#[derive(Default)]
struct Pace {
    began: Option<Instant>,
    scans: u64,
    lost: Duration,
}

impl Pace {
    fn wait(&mut self) {
        let began = *self.began.get_or_insert_with(Instant::now);
        self.scans += 1;
        if !self.scans.is_multiple_of(LOOK_SCANS) {
            return;
        }
        let due = Duration::from_secs_f64(self.scans as f64 / f64::from(SCAN_HZ)) + self.lost;
        let now = began.elapsed();
        if let Some(early) = due.checked_sub(now) {
            thread::sleep(early);
        } else if now - due > LAG_MAX {
            self.lost += now - due;
        }
    }
}

#[derive(Default)]
pub struct Use {
    /// None: as fast as it goes, and nobody sends anything.
    pub live: Option<Live>,
    pub streams_at_start: bool,
    /// Of a scene; the bound's search takes up to ten times as long as the run.
    pub without_bound: bool,
    /// Ends the run before its time.
    pub stop: Arc<AtomicBool>,
}

impl Use {
    pub fn of<P>(self, plant: P) -> Served<P> {
        Served { plant, line: self }
    }
}

pub struct Served<P> {
    pub plant: P,
    pub line: Use,
}

impl<P: Plant> Plant for Served<P> {
    tenax_scene::put_around!(plant);

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        if let Some(live) = &mut self.line.live {
            live.pace.wait();
            let act = live.person.hands().acts.pop_front();
            act.into_iter().for_each(|act| self.plant.act(act));
        }
        self.plant.scan(drive)
    }

    fn line_bytes(&mut self) -> Vec<u8> {
        let mut bytes = self.plant.line_bytes();
        if let Some(live) = &mut self.line.live {
            bytes.extend(live.bytes());
        }
        bytes
    }

    fn button(&self) -> bool {
        self.plant.button() || self.line.live.as_ref().is_some_and(|live| live.person.is_pressing())
    }

    fn kept(&self) -> Vec<(Kept, Vec<u8>)> {
        let Some(live) = &self.line.live else { return Vec::new() };
        live.person.hands().flash.clone()
    }

    fn keep(&mut self, kept: Kept, payload: &[u8]) {
        if let Some(live) = &self.line.live {
            let flash = &mut live.person.hands().flash;
            flash.retain(|(own, _)| *own != kept);
            flash.push((kept, payload.to_vec()));
        }
    }

    fn resets(&self) -> bool {
        self.line.stop.load(Relaxed) || self.line.live.as_ref().is_some_and(|live| live.person.hands().resets)
    }

    fn streams_at_start(&self) -> bool {
        self.line.streams_at_start || self.plant.streams_at_start()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::sync_channel;

    #[test]
    fn clients_bytes_come_down_no_faster_than_on_the_real_line_and_commands_than_a_board_takes_them() {
        for (length, expected) in [(250, 92_000..92_500), (10, 4_000..4_020)] {
            let (down, bytes) = sync_channel(1_000);
            (0..1_000).for_each(|_| down.send(vec![7; length]).unwrap());
            let mut live = Live::new(Arc::new(Mutex::new(bytes)), Person::default());
            let second: usize = (0..SCAN_HZ).map(|_| live.bytes().len()).sum();
            assert!(expected.contains(&second), "{second}");
        }
    }
}
