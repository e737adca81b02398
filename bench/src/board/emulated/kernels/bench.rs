//! Feeds the kernels' image and reads its answers.

use std::ops::Range;
use std::sync::mpsc::Sender;

use rigless::emulator::{Driver, Error, Host, Memory, Settled, Stop, Watch};
use rigless::session::Session;
use rigless::soc::Width;
use rigless::time::VirtualNanos;
use tenax_hal_shim::frame::Frame;
use tenax_logic::array::{ArrayVerdict, FEATURES, Reading};

use super::cycles::Tracer;
use super::meter::Meters;
use super::{Answer, Evidence, Kernels, Nucleo, Outcome};
use crate::image::kernels::KernelSymbols;

/// In place of the reading of an element that has none.
const NO_READING: u16 = u16::MAX;
/// Orders to the core: forget all that was read before.
const FORGET: u64 = 1;
/// Orders to the core: run every kernel, not the detector only.
const EVERYTHING: u64 = 2;
/// In the word of a verdict.
const SLIP: u32 = 1 << 15;
const CONFIDENCE: u32 = SLIP - 1;
/// Between two looks at whether it is over: 100 000 instructions.
const LOOK_NS: u64 = 1_000_000;
/// Looks without a new reading after which the core is given up: a reading takes less than two.
const PATIENCE: u32 = 20;
/// The chip's, where the image keeps all that changes.
const RAM: Range<u64> = 0x2000_0000..0x2002_0000;
/// Readings between two reports of progress.
const REPORTED: usize = 1_000;

/// The readings, and what became of them.
#[derive(Debug)]
pub struct Bench {
    symbols: KernelSymbols,
    /// Each with its recording, and whether it is the recording's first.
    readings: Vec<(usize, bool, Reading)>,
    everything: bool,
    /// After the readings.
    frames: Vec<Frame>,
    /// How many have been given to the core.
    fed: usize,
    outcome: Outcome,
    meters: Meters,
    done: bool,
    looks: u32,
    progress: Option<Sender<usize>>,
    /// From when on it follows.
    follow: Option<(usize, Tracer)>,
}

impl Bench {
    pub fn new(
        symbols: &KernelSymbols,
        recordings: &[Vec<Reading>],
        frames: &[Frame],
        kernels: Kernels,
        progress: Sender<usize>,
    ) -> Self {
        let readings = recordings.iter().enumerate().flat_map(|(recording, readings)| {
            readings.iter().enumerate().map(move |(place, reading)| (recording, place == 0, *reading))
        });
        Self {
            symbols: symbols.clone(),
            readings: readings.collect(),
            everything: kernels == Kernels::All,
            frames: frames.to_vec(),
            fed: 0,
            outcome: Outcome { answers: vec![Vec::new(); recordings.len()], ..Outcome::default() },
            meters: Meters::new(&symbols.kernels),
            done: false,
            looks: 0,
            progress: Some(progress),
            follow: None,
        }
    }

    /// The same, following the kernels from so many readings and frames on.
    pub fn following(self, follow: Option<(usize, Tracer)>) -> Self {
        Self { follow, ..self }
    }

    /// Whether every reading was answered.
    pub fn is_done(&self) -> bool {
        self.done
    }

    pub fn answered(&self) -> usize {
        self.outcome.answers.iter().map(Vec::len).sum()
    }

    /// Nobody listens any more.
    pub fn stop_reporting(&mut self) {
        self.progress = None;
    }

    pub fn into_outcome(self) -> Outcome {
        let cycles = self.follow.map(|(_, tracer)| tracer.means()).unwrap_or_default();
        Outcome { costs: self.meters.into_costs(), cycles, ..self.outcome }
    }

    /// The core has arrived at a watched instruction after having executed so many. Whether all was answered.
    pub fn arrive(&mut self, address: u64, executed: u64, memory: &mut dyn Memory) -> Result<bool, Error> {
        self.meters.hit(address, executed);
        if address == self.symbols.next {
            self.exchange(memory)?;
        }
        Ok(self.done)
    }

    /// The core stands at the mailbox: takes the answer to the last reading out, puts the next one in.
    fn exchange(&mut self, host: &mut dyn Memory) -> Result<(), Error> {
        self.looks = 0;
        let last = self.fed.checked_sub(1).and_then(|last| self.readings.get(last));
        if let Some(&(recording, ..)) = last {
            let answer = self.answer(host)?;
            self.outcome.answers[recording].push(answer);
        }
        let Some((_, first, reading)) = self.readings.get(self.fed) else {
            return self.exchange_frame(host);
        };
        for (element, sample) in reading.iter().enumerate() {
            let at = self.symbols.reading + 2 * element as u64;
            host.write(at, Width::W16, u64::from(sample.unwrap_or(NO_READING)))?;
        }
        let orders = if *first { FORGET } else { 0 } | if self.everything { EVERYTHING } else { 0 };
        host.write(self.symbols.orders, Width::W32, orders)?;
        self.fed += 1;
        if let Some(progress) = self.progress.as_ref().filter(|_| self.fed.is_multiple_of(REPORTED)) {
            // Nobody listening is no reason to stop.
            let _ = progress.send(self.fed);
        }
        Ok(())
    }

    /// Puts the next frame in; the core answers nothing to it.
    fn exchange_frame(&mut self, host: &mut dyn Memory) -> Result<(), Error> {
        let next = self.frames.get(self.fed - self.readings.len());
        let (Some(frame), Some([samples_at, comes])) = (next, self.symbols.frame) else {
            self.done = true;
            for at in RAM.step_by(4) {
                self.outcome.ram.push(host.read(at, Width::W32)? as u32);
            }
            return Ok(());
        };
        let samples = frame.pvdf.into_iter().chain([frame.switch_a, frame.switch_b]);
        for (n, sample) in samples.enumerate() {
            host.write(samples_at + 2 * n as u64, Width::W16, u64::from(sample))?;
        }
        host.write(comes, Width::W32, 1)?;
        self.fed += 1;
        Ok(())
    }

    fn answer(&self, host: &mut dyn Memory) -> Result<Answer, Error> {
        let verdict = host.read(self.symbols.verdict, Width::W32)? as u32;
        let verdict = ArrayVerdict {
            slip: verdict & SLIP != 0,
            confidence_permille: (verdict & CONFIDENCE) as u16,
            age_ms: (verdict >> 16) as u16,
        };
        if host.read(self.symbols.judged, Width::W32)? == 0 {
            return Ok(Answer { verdict, evidence: None });
        }
        let mut features = [0; FEATURES];
        for (n, feature) in features.iter_mut().enumerate() {
            *feature = host.read(self.symbols.features + 2 * n as u64, Width::W16)? as u16 as i16;
        }
        let logit = host.read(self.symbols.logit, Width::W32)? as u32 as i32;
        Ok(Answer { verdict, evidence: Some(Evidence { features, logit }) })
    }
}

impl Driver<Nucleo> for Bench {
    fn on_settled(&mut self, session: &mut Session<Nucleo>, host: &mut dyn Host, settled: Settled) {
        let Settled::Hit(hit) = settled else { return };
        if self.done {
            return;
        }
        if let Some((from, tracer)) = self.follow.as_mut().filter(|(from, _)| self.fed >= *from) {
            tracer.hit(hit.address);
            if hit.address == self.symbols.next && self.fed == *from {
                tracer.watched().for_each(|address| session.watch(Watch::Instruction(address)));
            }
        }
        self.arrive(hit.address, hit.instruction_count, host).expect("the mailbox is in the image's memory");
    }

    fn on_stop(
        &mut self,
        _session: &mut Session<Nucleo>,
        stop: Stop,
        _host: &mut dyn Host,
    ) -> Option<VirtualNanos> {
        self.looks += 1;
        let over = self.done || self.looks > PATIENCE;
        (!over).then_some(VirtualNanos(stop.at.0 + LOOK_NS))
    }
}
