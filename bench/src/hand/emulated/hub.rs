//! Where the images wait for each other, and what lies between them: object and wires.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

use anyhow::{Result, bail};
use tenax_hal_shim::channel::{COUNT, SCAN_HZ, SCANS_PER_FRAME};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Received, Receiver};
use tenax_palm::bus::{Packet, Word};
use tenax_scene::fingers::Fingers;

use super::DELAY_SLOTS;

/// A byte on the wires, ns.
pub const SLOT_NS: u64 = 2_000;
/// From one stop to the next, ns.
pub const STOP_NS: u64 = 12_500;
/// Of a scan's trigger to its last code (`firmware/src/scan.rs`).
const SCAN_TAKES_US: f64 = 38.0;
/// So long an image is waited for: it translates at its start.
const PATIENCE: Duration = Duration::from_secs(120);

/// What an image did since the last stop. Times count from its first scan's stop, ns.
#[derive(Debug, Default)]
pub struct Did {
    /// When it scans: how its motor is driven.
    pub drive: Option<MotorDrive>,
    /// Bytes, and when each was over.
    pub bytes: Vec<(u64, u8)>,
    /// Its driver went on or off.
    pub drivers: Vec<(u64, bool)>,
    pub now_ns: u64,
}

/// What an image is given.
#[derive(Debug, Default)]
pub struct Given {
    /// What its converter's pins show, if it scans.
    pub codes: Option<[u16; COUNT]>,
    /// Bytes, and when each begins.
    pub bytes: Vec<(u64, u8)>,
}

/// What is on an image's side of the wires.
#[derive(Debug, Default)]
struct Side {
    bytes: VecDeque<(u64, u8)>,
    drivers: VecDeque<(u64, bool)>,
    is_on: bool,
}

/// Object and wires.
#[derive(Debug)]
pub struct Hand {
    pub fingers: Fingers,
    pub garbled: u64,
    /// From a poll's end to its answer's beginning, ns, at most.
    pub answer_ns: u64,
    /// How far the end of a frame that the palm was told was off, us.
    pub clock_us: f64,
    /// The longest cycle of polls, us, and how many there were.
    pub cycle_us: u32,
    pub cycles: u32,
    /// Of the fingers and, last, of the palm.
    sides: Vec<Side>,
    slot: u64,
    /// Whoever listens to the wires: frames, and in which slot one began.
    listener: Receiver,
    began: Option<u64>,
    asked_ns: Option<u64>,
    /// What the palm's clock shows more than ours, us.
    ahead_us: f64,
    /// Who was asked last, and when the cycle began, us.
    asked: u8,
    cycle_began_us: Option<f64>,
}

impl Hand {
    pub fn new(fingers: Fingers) -> Self {
        let count = fingers.fingers().len();
        Self {
            fingers,
            garbled: 0,
            answer_ns: 0,
            clock_us: 0.0,
            cycle_us: 0,
            cycles: 0,
            sides: (0..=count).map(|_| Side::default()).collect(),
            slot: 0,
            listener: Receiver::new(),
            began: None,
            asked_ns: None,
            ahead_us: 0.0,
            asked: 0,
            cycle_began_us: None,
        }
    }

    /// All images have come to the same stop.
    fn stop(&mut self, did: Vec<Did>) -> Vec<Given> {
        let mut given: Vec<Given> = did.iter().map(|_| Given::default()).collect();
        let until_ns = did.iter().map(|did| did.now_ns).min().unwrap_or(0);
        let count = self.fingers.fingers().len();
        let drives: Option<Vec<MotorDrive>> = did.iter().take(count).map(|did| did.drive).collect();
        for (side, did) in self.sides.iter_mut().zip(did) {
            side.bytes.extend(did.bytes);
            side.drivers.extend(did.drivers);
        }
        while (self.slot + 1) * SLOT_NS <= until_ns {
            self.pass(&mut given);
            self.slot += 1;
        }
        if let Some(drives) = drives {
            self.fingers.scan(&drives);
            for (given, finger) in given.iter_mut().zip(self.fingers.fingers()) {
                given.codes = Some(finger.pins().codes());
            }
        }
        given
    }

    /// One byte's time on the wires.
    fn pass(&mut self, given: &mut [Given]) {
        let ends_ns = (self.slot + 1) * SLOT_NS;
        let mut spoken: Vec<(usize, u8)> = Vec::new();
        let mut on = 0;
        for (n, side) in self.sides.iter_mut().enumerate() {
            let was_on = side.is_on;
            while let Some((_, is_on)) = side.drivers.pop_front_if(|(at, _)| *at < ends_ns) {
                side.is_on = is_on;
            }
            on += usize::from(side.is_on || was_on);
            while let Some((_, byte)) = side.bytes.pop_front_if(|(at, _)| *at <= ends_ns) {
                // Without its driver nobody hears it.
                if side.is_on || was_on {
                    spoken.push((n, byte));
                }
            }
        }
        let Some(&(by, byte)) = spoken.first() else { return };
        let alone = spoken.len() == 1 && on == 1;
        let byte = if alone { byte } else { spoken.iter().fold(0x81, |all, (_, byte)| all ^ byte) | 1 };
        self.garbled += u64::from(!alone);
        for (n, (side, given)) in self.sides.iter().zip(given).enumerate() {
            // Its receiver is off while its driver is on.
            if !side.is_on && by != n {
                given.bytes.push(((self.slot + DELAY_SLOTS) * SLOT_NS, byte));
            }
        }
        self.listen(byte, by + 1 == self.sides.len());
    }

    /// A byte was on the wires, the palm's or a finger's.
    fn listen(&mut self, byte: u8, palm: bool) {
        let (slot, ends_ns) = (self.slot, (self.slot + 1) * SLOT_NS);
        if !palm && let Some(asked_ns) = self.asked_ns.take() {
            let took_ns = (slot * SLOT_NS).saturating_sub(asked_ns + DELAY_SLOTS * SLOT_NS);
            self.answer_ns = self.answer_ns.max(took_ns);
        }
        if byte != 0 {
            self.began.get_or_insert(slot);
        }
        let heard = self.listener.push::<Packet>(byte);
        let Some(began) = self.began.filter(|_| byte == 0) else { return };
        self.began = None;
        // A zero came before it.
        let began_us = (began.saturating_sub(1) * SLOT_NS) as f64 / 1e3;
        let Some(Ok(Received { message: Packet { address, word }, .. })) = heard else { return };
        match word {
            Word::Poll(poll) => {
                self.asked_ns = Some(ends_ns);
                self.ahead_us = f64::from(poll.stamp_us) - began_us;
                // Whoever comes before the last one begins the next cycle.
                if address <= std::mem::replace(&mut self.asked, address) {
                    let before_us = self.cycle_began_us.replace(began_us);
                    self.cycle_us = self.cycle_us.max(before_us.map_or(0.0, |us| began_us - us) as u32);
                    self.cycles += 1;
                }
            }
            Word::State(state) if state.frame_at_us > 0 => {
                let scans = (f64::from(state.frame) + 1.0) * SCANS_PER_FRAME as f64 - 1.0;
                let ended_us = scans * 1e6 / f64::from(SCAN_HZ) + SCAN_TAKES_US;
                let told_us = f64::from(state.frame_at_us) - self.ahead_us;
                self.clock_us = self.clock_us.max((told_us - ended_us).abs());
            }
            _ => {}
        }
    }
}

/// A barrier that the hand works at.
#[derive(Debug)]
pub struct Hub {
    state: Mutex<State>,
    turn: Condvar,
    count: usize,
}

#[derive(Debug)]
struct State {
    hand: Hand,
    did: Vec<Option<Did>>,
    given: Vec<Option<Given>>,
    round: u64,
    is_broken: bool,
}

impl Hub {
    pub fn new(hand: Hand) -> Self {
        let count = hand.sides.len();
        let nobody = || (0..count).map(|_| None).collect();
        let given = (0..count).map(|_| None).collect();
        let state = State { hand, did: nobody(), given, round: 0, is_broken: false };
        Self { state: Mutex::new(state), turn: Condvar::new(), count }
    }

    /// Image `n` comes to a stop and waits for the others. None if one of them does not come any more.
    pub fn meet(&self, n: usize, did: Did) -> Option<Given> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.did[n] = Some(did);
        if state.did.iter().flatten().count() == self.count {
            let did = state.did.iter_mut().filter_map(Option::take).collect();
            state.given = state.hand.stop(did).into_iter().map(Some).collect();
            state.round += 1;
            self.turn.notify_all();
        } else {
            let round = state.round;
            let waits = |state: &mut State| state.round == round && !state.is_broken;
            let (woken, timeout) =
                self.turn.wait_timeout_while(state, PATIENCE, waits).unwrap_or_else(PoisonError::into_inner);
            state = woken;
            state.is_broken |= timeout.timed_out();
        }
        if state.is_broken { None } else { state.given[n].take() }
    }

    /// An image is gone before its time: nobody waits for it.
    pub fn leave(&self) {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).is_broken = true;
        self.turn.notify_all();
    }

    /// What has become of the hand.
    pub fn into_hand(self) -> Result<Hand> {
        let state = self.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        if state.is_broken {
            bail!("an image did not come to a stop that the others waited at");
        }
        Ok(state.hand)
    }
}
