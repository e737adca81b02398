//! The world around the emulated chip: every 125 us a plant's scan goes in, and what the chip does comes out.

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::anyhow;
use rigless::emulator::{Driver, Host, Settled, Stop};
use rigless::session::Session;
use rigless::time::VirtualNanos;
use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, SCAN_HZ, SCANS_PER_FRAME};
use tenax_hal_shim::frame::{Scan, scan_of_pins};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{Answer, Down, Received, Receiver};
use tenax_scene::plant::Plant;

use super::Options;
use super::cost::{CostMeter, stack_used};
use super::coupling::Coupling;
use super::flash::FlashArray;
use super::mishaps::Mishaps;
use super::nucleo::Nucleo;
use super::wires::{BUTTON, Wires};
use crate::board::TickCost;
use crate::image::symbols::Symbols;
use tenax_frames::link::Encoder;

const SCAN_NS: u64 = 1_000_000_000 / SCAN_HZ as u64;
const SEEK_NS: u64 = 5_000;
const BOOT_NS: u64 = 3_000_000_000;
/// A board whose supply is low waits for it, and does not scan: the world begins without it.
const WAITS_NS: u64 = 300_000_000;
/// Scans after the plant's last, so that what they led to comes up the line.
const DRAIN_SCANS: u32 = 64;
/// Scans between two reports, so that a line that is served live is late by no more than a slow frame.
const REPORT_SCANS: usize = SCANS_PER_FRAME * FRAMES_PER_SLOW_FRAME as usize;

#[derive(Debug, Default)]
pub struct Stretch {
    pub scans: Vec<(Scan, MotorDrive)>,
    pub line: Vec<u8>,
}

pub struct World {
    plant: Arc<Mutex<dyn Plant>>,
    pub tick_cost: Option<TickCost>,
    pub stack_bytes: Option<u64>,
    pub broken: Option<anyhow::Error>,
    cost: CostMeter,
    coupling: Option<Coupling>,
    sent_commands: VecDeque<Received<Down>>,
    taken_before: Vec<u32>,
    pub flash: FlashArray,
    scans: usize,
    scanned: usize,
    drained: u32,
    pulses: u64,
    stepped_at: Option<VirtualNanos>,
    begins_ns: u64,
    codes: Scan,
    encoder: Encoder,
    sent: Receiver,
    pub feedback: Vec<(usize, Duty)>,
    mishaps: Mishaps,
    resets: usize,
    executed: Option<(VirtualNanos, u64)>,
    stack: Range<u64>,
    command_entry: u64,
    stretch: Stretch,
    pub reports: Option<Sender<Stretch>>,
}

impl World {
    pub fn new(
        plant: Arc<Mutex<dyn Plant>>,
        frames: u32,
        options: &Options,
        symbols: &Symbols,
        reports: Sender<Stretch>,
    ) -> Self {
        Self {
            plant,
            tick_cost: None,
            stack_bytes: None,
            broken: None,
            cost: CostMeter::new(symbols),
            coupling: options.coupling,
            sent_commands: VecDeque::new(),
            taken_before: Vec::new(),
            flash: FlashArray::new(1_000 * options.word_us),
            scans: frames as usize * SCANS_PER_FRAME,
            scanned: 0,
            drained: 0,
            pulses: 0,
            stepped_at: None,
            begins_ns: if options.supply_mv < 3_030 { WAITS_NS } else { u64::MAX },
            codes: Scan::default(),
            encoder: Encoder::default(),
            sent: Receiver::new(),
            feedback: Vec::new(),
            mishaps: Mishaps::new(&options.mishaps),
            resets: 0,
            executed: None,
            stack: symbols.stack.clone(),
            command_entry: symbols.command,
            stretch: Stretch::default(),
            reports: Some(reports),
        }
    }

    /// The commands that were answered, each with the tick before which the image took it.
    pub fn taken(&mut self, answers: &[(u16, Answer)]) -> Vec<(u32, Received<Down>)> {
        let answered = answers.iter().filter_map(|(of, _)| {
            // What the line swallowed was never answered.
            std::iter::from_fn(|| self.sent_commands.pop_front()).find(|command| command.sequence == *of)
        });
        self.taken_before.iter().copied().zip(answered).collect()
    }

    /// One scan period of the world. None when it is over.
    fn step(
        &mut self,
        session: &mut Session<Nucleo>,
        stop: Stop,
        host: &mut dyn Host,
        pulse: bool,
    ) -> Option<()> {
        let mut plant = self.plant.lock().unwrap_or_else(PoisonError::into_inner);
        if plant.resets() {
            return None;
        }
        let mut wires = Wires::new(session.board_mut(), stop.at);
        if self.scanned < self.scans {
            let Some(drive) = wires.motor() else {
                self.broken = Some(anyhow!(
                    "the motor bridge neither coasts nor drives with slow decay at {} s: duty is not the motor's voltage",
                    seconds(stop.at)
                ));
                return None;
            };
            let vibration = wires.vibration();
            if self.feedback.last().map_or(Duty::default(), |last| last.1) != vibration {
                self.feedback.push((self.scanned, vibration));
                plant.vibrate(vibration);
            }
            let pins = plant.scan(drive).codes();
            self.codes = scan_of_pins(&pins, wires.select());
            if let Some(coupling) = self.coupling {
                coupling.add(&mut self.codes, drive, wires.bridge_begins_us());
            }
            self.stretch.scans.push((self.codes, drive));
            self.scanned += 1;
        } else {
            self.drained += 1;
        }
        wires.put(&self.codes);
        wires.pull(BUTTON, plant.button());
        if pulse {
            wires.trigger();
        }
        let scan = self.scanned;
        if let Some(line) = session.board_mut().line() {
            let opening = line.offered.take().map(|nonce| Down::Open { nonce });
            for command in opening.into_iter().chain(plant.commands()) {
                if command == Down::Hello {
                    line.listener = Some(Receiver::default());
                }
                let (number, frame) = self.encoder.frame(&command);
                line.down.extend(frame);
                self.sent_commands.push_back(Received { sequence: number, message: command });
            }
            for byte in plant.line_bytes() {
                line.down.push_back(byte);
                if let Some(Ok(command)) = self.sent.push::<Down>(byte) {
                    self.sent_commands.push_back(command);
                }
            }
        }
        drop(plant);
        self.mishaps.happen(scan, session, stop, &mut self.flash, host);
        if scan.is_multiple_of(REPORT_SCANS) {
            self.report(session);
        }
        (self.drained < DRAIN_SCANS).then_some(())
    }

    fn report(&mut self, session: &mut Session<Nucleo>) {
        if let Some(line) = session.board_mut().line() {
            self.stretch.line = std::mem::take(&mut line.up);
        }
        if let Some(reports) = &self.reports {
            // Nobody listening is no reason to stop.
            let _ = reports.send(std::mem::take(&mut self.stretch));
        }
    }

    fn end(&mut self, session: &mut Session<Nucleo>, stop: Stop, host: &mut dyn Host) {
        let (began, executed) = self.executed.unwrap_or((stop.at, stop.instruction_count));
        let lasted_s = seconds(stop.at) - seconds(began);
        self.tick_cost = self.cost.cost((stop.instruction_count - executed) as f64 / lasted_s);
        self.stack_bytes = Some(stack_used(&self.stack, host));
        self.report(session);
    }
}

impl Driver<Nucleo> for World {
    fn on_settled(&mut self, session: &mut Session<Nucleo>, host: &mut dyn Host, settled: Settled) {
        match settled {
            Settled::Hit(hit) if hit.address == self.command_entry => {
                self.taken_before.push(self.cost.count as u32)
            }
            Settled::Hit(hit) if [self.cost.tick, self.cost.after_tick].contains(&hit.address) => {
                self.cost.hit(hit)
            }
            Settled::Access { access, .. } => {
                self.flash.accessed(&access, session, host);
                self.mishaps.accessed(&access, session);
            }
            Settled::Stop(stop) => self.flash.stopped(stop, session, host),
            _ => {}
        }
    }

    fn on_stop(
        &mut self,
        session: &mut Session<Nucleo>,
        stop: Stop,
        host: &mut dyn Host,
    ) -> Option<VirtualNanos> {
        if session.resets().len() > self.resets {
            self.resets = session.resets().len();
            self.pulses = 0;
            self.flash.reset();
            // A reset ends a hang.
            host.hold(false);
        }
        let pulses = session.board_mut().trigger_pulses(stop.at);
        let pulse = pulses > self.pulses;
        self.pulses = pulses;
        let due = stop.at.0 >= self.stepped_at.map_or(self.begins_ns, |at| at.0 + SCAN_NS);
        if self.stepped_at.is_none() && pulse {
            self.executed = Some((stop.at, stop.instruction_count));
        }
        if pulse || due {
            self.stepped_at = Some(stop.at);
            if self.step(session, stop, host, pulse).is_none() {
                self.end(session, stop, host);
                return None;
            }
        } else if self.stepped_at.is_none() && stop.at.0 > BOOT_NS {
            self.broken = Some(anyhow!("the image had not begun to scan three seconds after its start"));
            return None;
        }
        Some(VirtualNanos(stop.at.0 + if pulse { SCAN_NS } else { SEEK_NS }))
    }
}

fn seconds(at: VirtualNanos) -> f64 {
    at.0 as f64 / 1e9
}
