//! The palm's end of the bus: it gives addresses, polls, notices who is lost or babbles, and wishes for forces.

use heapless::{Deque, Vec};
use serde::{Deserialize, Serialize};
use tenax_hal_shim::wire::{Receiver, encode};
use tenax_logic::force::friction::LEAST_PERMILLE;

use crate::bus::{
    ALL, BEGINS_US, CLAIM_SLOT_US, CLAIM_SLOTS, CYCLE_US, Chip, FINGERS_MAX, FRAME_MAX, Felt, MISSED_MAX,
    Packet, Poll, State, Word, bytes_us,
};
use crate::places::{Place, Places};
use crate::share::{Contact, Forces, load, share};

/// Cycles between two sharings: 12 ms.
const SHARE_CYCLES: u32 = 6;
/// The force that a finger keeps, as a part of what its shear needs by its S2, per mille: from here on its reflex warns itself, too, but aims
/// higher. This and the next chosen on the scenes of `scenes/hand/`, seeds 1 to 8.
const KEEPS_PERMILLE: i32 = 1_000;
/// The same while a neighbour slips and so long after, us: what that one lets go of, the others bear.
const KEEPS_SLIP_PERMILLE: i32 = 1_050;
const SLIP_US: u32 = 100_000;
/// Answers that nobody asked for, after which a finger is cut off, and for how long, us.
const STRIKES_MAX: u8 = 3;
const CUT_US: u32 = 1_000_000;
/// Cycles after which they are forgiven: 1 s.
const STRIKES_CYCLES: u32 = 500;
/// Silence between two frames, us.
const GAP_US: u32 = 10;
/// Bytes in [`NOISE_US`] that belong to no answer, from which the bus is noisy.
const NOISE_MAX: u32 = 64;
const NOISE_US: u32 = 50_000;
/// From one stranger's report to the next, us.
pub const STRANGER_US: u32 = 300_000;

/// What happened on the bus. Addresses count from 1 on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Report {
    /// The finger answers.
    Found(u8),
    /// It has not answered three polls in a row.
    Lost(u8),
    /// It spoke without being asked, and is not listened to for a second.
    Cut(u8),
    /// All fingers are lost.
    BusLost,
    /// Somebody says what belongs to no answer.
    Noise,
    /// A finger that has no place in this hand: at most one in [`STRANGER_US`], so that a hand that knows nobody hears of all of them.
    Stranger(Chip),
}

#[derive(Clone, Debug)]
struct Seat {
    place: Place,
    /// It has its address.
    is_known: bool,
    number: u16,
    missed: u8,
    strikes: u8,
    cut_us: Option<u32>,
    /// It says slip, or did until then.
    slips_until: Option<u32>,
    state: Option<State>,
    want_mn: Option<u16>,
    /// What it pressed with when it was lost, mN: its gear holds.
    held_mn: Option<u16>,
    line: Deque<u8, 256>,
    assign: Option<u32>,
    release: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// Nobody has been asked.
    Free,
    /// This seat has been asked, and answers from then on at the latest, or ends then.
    Asked { seat: usize, until_us: u32, has_begun: bool },
    /// Whoever has no address may speak until then.
    Claims { until_us: u32 },
}

/// The palm.
#[derive(Debug)]
pub struct Palm {
    seats: Vec<Seat, FINGERS_MAX>,
    receiver: Receiver,
    stage: Stage,
    /// Nothing is sent before.
    free_us: u32,
    cycle_us: u32,
    cycles: u32,
    longest_us: u32,
    next: usize,
    has_claimed: bool,
    is_fresh: bool,
    /// Nothing more is to be said in this cycle, unless something is heard.
    rests: bool,
    claim: u8,
    stray: u32,
    stray_us: u32,
    is_noisy: bool,
    lacking: bool,
    stranger_us: u32,
    reports: Deque<Report, 16>,
}

impl Seat {
    fn felt(&self) -> Option<Felt> {
        self.state.as_ref()?.felt
    }
}

/// Whether `until_us` is reached, across the clock's wrap.
const fn reached(now_us: u32, until_us: u32) -> bool {
    now_us.wrapping_sub(until_us) < u32::MAX / 2
}

impl Palm {
    /// A palm of a hand with these places, of which the first [`FINGERS_MAX`] count, at this time by its clock.
    pub fn new(places: &[Place], now_us: u32) -> Self {
        let seat = |&place: &Place| Seat {
            place,
            is_known: false,
            number: 0,
            missed: 0,
            strikes: 0,
            cut_us: None,
            slips_until: None,
            state: None,
            want_mn: None,
            held_mn: None,
            line: Deque::new(),
            assign: None,
            release: false,
        };
        Self {
            seats: places.iter().take(FINGERS_MAX).map(seat).collect(),
            receiver: Receiver::new(),
            stage: Stage::Free,
            free_us: now_us,
            cycle_us: now_us,
            cycles: 0,
            longest_us: 0,
            next: 0,
            has_claimed: false,
            is_fresh: true,
            rests: false,
            claim: 0,
            stray: 0,
            stray_us: now_us,
            is_noisy: false,
            lacking: false,
            stranger_us: now_us.wrapping_sub(STRANGER_US),
            reports: Deque::new(),
        }
    }

    /// From when on [`step`](Self::step) does something, if nothing is heard before.
    #[must_use]
    pub const fn due_us(&self) -> u32 {
        let until_us = match self.stage {
            Stage::Asked { until_us, .. } | Stage::Claims { until_us } => until_us,
            Stage::Free if self.rests => self.cycle_us.wrapping_add(CYCLE_US),
            Stage::Free => self.free_us,
        };
        if reached(until_us, self.free_us) { until_us } else { self.free_us }
    }

    /// Whether [`step`](Self::step) would do anything.
    #[must_use]
    pub const fn is_due(&self, now_us: u32) -> bool {
        reached(now_us, self.due_us())
    }

    /// How many bytes of `out` are to be sent now; mostly none. Call it whenever nothing is being sent, within 10 us of when it is due.
    pub fn step(&mut self, now_us: u32, out: &mut [u8; FRAME_MAX]) -> usize {
        if !self.is_due(now_us) {
            return 0;
        }
        if let Stage::Asked { seat, .. } = self.stage {
            self.miss(seat);
        }
        (self.stage, self.rests) = (Stage::Free, false);
        let length = self.speak(now_us, out).unwrap_or(0);
        if length > 0 {
            // What was garbled before ends here, too.
            let _garbled = self.receiver.push::<Packet>(0);
        }
        self.free_us = now_us.wrapping_add(bytes_us(length as u32));
        match &mut self.stage {
            Stage::Asked { until_us, .. } => *until_us = self.free_us.wrapping_add(BEGINS_US),
            Stage::Claims { until_us } => *until_us = until_us.wrapping_add(bytes_us(length as u32)),
            Stage::Free => {}
        }
        length
    }

    /// What is to be said next, if anything.
    fn speak(&mut self, now_us: u32, out: &mut [u8; FRAME_MAX]) -> Option<usize> {
        if core::mem::take(&mut self.is_fresh) {
            // Whoever has an address has it from another palm.
            return frame(0, ALL, Word::Release, out);
        }
        for (n, seat) in self.seats.iter_mut().enumerate() {
            let address = n as u8 + 1;
            if core::mem::take(&mut seat.release) {
                return frame(0, address, Word::Release, out);
            }
            if let Some(nonce) = seat.assign.take() {
                (seat.is_known, seat.number, seat.missed) = (true, 0, 0);
                return frame(0, address, Word::Assign { chip: seat.place.chip, nonce }, out);
            }
        }
        let slips = self.slips();
        while let Some(seat) = self.seats.get_mut(self.next) {
            let n = self.next;
            self.next += 1;
            if !seat.is_known {
                continue;
            }
            seat.number = seat.number.wrapping_add(1);
            let mut line = crate::finger::Line::new();
            while !line.is_full()
                && let Some(byte) = seat.line.pop_front()
            {
                let _fits = line.push(byte);
            }
            let poll = Poll { stamp_us: now_us, slips, want_mn: seat.want_mn, line };
            self.stage = Stage::Asked { seat: n, until_us: now_us, has_begun: false };
            return frame(seat.number, n as u8 + 1, Word::Poll(poll), out);
        }
        // One place in time for each that is missing: with four fingers there is no more room. Who knows no finger looks for all.
        let missing = self.seats.iter().filter(|seat| !seat.is_known && seat.cut_us.is_none()).count();
        let slots = if self.seats.is_empty() { CLAIM_SLOTS } else { CLAIM_SLOTS.min(missing as u8) };
        let window_us = BEGINS_US + u32::from(slots) * CLAIM_SLOT_US;
        let since_us = now_us.wrapping_sub(self.cycle_us);
        if slots > 0 && !self.has_claimed && since_us + 40 + window_us <= CYCLE_US {
            self.has_claimed = true;
            self.claim = self.claim.wrapping_add(1);
            self.stage = Stage::Claims { until_us: now_us.wrapping_add(window_us) };
            return frame(0, ALL, Word::Claim { round: self.claim, slots }, out);
        }
        if since_us >= CYCLE_US {
            self.begin(now_us, since_us);
        } else {
            self.rests = true;
        }
        None
    }

    fn begin(&mut self, now_us: u32, since_us: u32) {
        self.longest_us = self.longest_us.max(since_us);
        (self.cycle_us, self.next, self.has_claimed) = (now_us, 0, false);
        self.cycles = self.cycles.wrapping_add(1);
        for seat in &mut self.seats {
            seat.cut_us = seat.cut_us.filter(|&until_us| !reached(now_us, until_us));
            seat.slips_until = seat.slips_until.filter(|&until_us| !reached(now_us, until_us));
            seat.strikes = if self.cycles.is_multiple_of(STRIKES_CYCLES) { 0 } else { seat.strikes };
        }
        if self.cycles.is_multiple_of(SHARE_CYCLES) {
            self.allot();
        }
        if reached(now_us, self.stray_us.wrapping_add(NOISE_US)) {
            let is_noisy = self.stray >= NOISE_MAX;
            if is_noisy && !self.is_noisy {
                self.report(Report::Noise);
            }
            (self.stray, self.stray_us, self.is_noisy) = (0, now_us, is_noisy);
        }
    }

    /// A byte is over at `now_us`. Some when it ends an answer: whose, from 0 on.
    pub fn hear(&mut self, byte: u8, now_us: u32) -> Option<usize> {
        match &mut self.stage {
            Stage::Asked { until_us, has_begun, .. } => {
                if !core::mem::replace(has_begun, true) {
                    *until_us = now_us.wrapping_add(bytes_us(FRAME_MAX as u32));
                }
            }
            Stage::Claims { .. } => {}
            Stage::Free => self.stray = self.stray.saturating_add(1),
        }
        self.rests = false;
        let packet = match self.receiver.push::<Packet>(byte)? {
            Ok(received) => received.message,
            Err(_) => {
                self.stray = self.stray.saturating_add(1);
                return None;
            }
        };
        match (packet.word, self.stage) {
            (Word::State(state), Stage::Asked { seat, .. }) if packet.address == seat as u8 + 1 => {
                self.stage = Stage::Free;
                self.free_us = now_us.wrapping_add(GAP_US);
                self.answered(seat, state, now_us);
                Some(seat)
            }
            (Word::Here { chip, nonce }, stage) => {
                if let Stage::Asked { .. } = stage {
                    // Its session is over.
                    self.stage = Stage::Free;
                }
                match self.seats.iter_mut().find(|seat| seat.place.chip == chip) {
                    Some(seat) if seat.cut_us.is_none() => seat.assign = Some(nonce),
                    Some(_) => {}
                    None if reached(now_us, self.stranger_us.wrapping_add(STRANGER_US)) => {
                        self.stranger_us = now_us;
                        self.report(Report::Stranger(chip));
                    }
                    None => {}
                }
                None
            }
            (word, _) => {
                self.stray = self.stray.saturating_add(FRAME_MAX as u32);
                if let Word::State(_) = word {
                    self.strike(packet.address, now_us);
                }
                None
            }
        }
    }

    fn answered(&mut self, n: usize, state: State, now_us: u32) {
        let Some(seat) = self.seats.get_mut(n) else { return };
        if seat.state.is_none() {
            let _full = self.reports.push_back(Report::Found(n as u8 + 1));
        }
        // Who contracts moves the hand alone, from this answer on, not from the next sharing.
        let contracts = state.wearer && !seat.state.as_ref().is_some_and(|before| before.wearer);
        let begins = !state.slip.is_empty() && seat.slips_until.is_none();
        if !state.slip.is_empty() {
            seat.slips_until = Some(now_us.wrapping_add(SLIP_US));
        }
        (seat.missed, seat.held_mn) = (0, None);
        seat.state = Some(state);
        if begins || contracts {
            self.allot();
        }
    }

    fn miss(&mut self, n: usize) {
        let Some(seat) = self.seats.get_mut(n) else { return };
        seat.missed = seat.missed.saturating_add(1);
        if seat.missed >= MISSED_MAX {
            self.lose(n, Report::Lost(n as u8 + 1));
        }
    }

    /// A finger that answers what nobody asked.
    fn strike(&mut self, address: u8, now_us: u32) {
        let n = usize::from(address).wrapping_sub(1);
        let Some(seat) = self.seats.get_mut(n).filter(|seat| seat.cut_us.is_none()) else { return };
        seat.strikes += 1;
        if seat.strikes >= STRIKES_MAX {
            seat.cut_us = Some(now_us.wrapping_add(CUT_US));
            self.lose(n, Report::Cut(address));
        }
    }

    fn lose(&mut self, n: usize, report: Report) {
        let Some(seat) = self.seats.get_mut(n) else { return };
        let was_heard = seat.state.is_some();
        seat.held_mn =
            seat.state.as_ref().and_then(|state| state.felt).map(|felt| felt.load_mn).or(seat.held_mn);
        (seat.is_known, seat.missed, seat.strikes, seat.release) = (false, 0, 0, true);
        (seat.state, seat.want_mn, seat.slips_until, seat.assign) = (None, None, None, None);
        if was_heard || matches!(report, Report::Cut(_)) {
            self.report(report);
        }
        if was_heard && self.seats.iter().all(|seat| seat.state.is_none()) {
            self.report(Report::BusLost);
        }
    }

    fn report(&mut self, report: Report) {
        if self.reports.is_full() {
            self.reports.pop_front();
        }
        let _has_room = self.reports.push_back(report);
    }

    /// The fingers that say slip now, a bit for each address from 1 on.
    fn slips(&self) -> u8 {
        self.seats.iter().enumerate().fold(0, |slips, (n, seat)| {
            let slip = seat.state.as_ref().is_some_and(|state| !state.slip.is_empty());
            slips | u8::from(slip) << n
        })
    }

    /// Wishes for the least forces that keep each finger's margin. Whoever has its margin is wished nothing.
    fn allot(&mut self) {
        let slips = self.seats.iter().any(|seat| seat.slips_until.is_some());
        let keeps = if slips { KEEPS_SLIP_PERMILLE } else { KEEPS_PERMILLE };
        let mut contacts: Vec<Contact, FINGERS_MAX> = Vec::new();
        let mut felt_mn = Forces::new();
        let is_held = self.seats.iter().any(|seat| seat.felt().is_some());
        for seat in &mut self.seats {
            // Whoever held it with the others has let go, too.
            seat.held_mn = seat.held_mn.filter(|_| is_held);
            let Place { normal, ceiling_mn: most_mn, .. } = seat.place;
            let (least_mn, load_mn) = match (seat.felt(), seat.held_mn) {
                (Some(felt), _) => {
                    let friction = i32::from(felt.friction_permille.max(LEAST_PERMILLE));
                    (i32::from(felt.ft_mn) * keeps / friction, felt.load_mn)
                }
                // A wall: it presses as the others press against it.
                (None, Some(held_mn)) => (0, held_mn),
                (None, None) => continue,
            };
            let _fits = (contacts.push(Contact { normal, least_mn, most_mn }), felt_mn.push(load_mn.into()));
        }
        // The wearer's gate is the palm's, too: who contracts moves the hand alone.
        let wearer = self.seats.iter().any(|seat| seat.state.as_ref().is_some_and(|state| state.wearer));
        let shared = share(&contacts, load(&contacts, &felt_mn)).filter(|_| !wearer && contacts.len() > 1);
        self.lacking = shared.is_none() && contacts.len() > 1 && !wearer;
        let mut shares = contacts.iter().zip(&felt_mn).zip(shared.iter().flatten());
        for seat in &mut self.seats {
            seat.want_mn = None;
            if (seat.felt().is_some() || seat.held_mn.is_some())
                && let Some(((contact, &felt_mn), &share_mn)) = shares.next()
                && seat.felt().is_some()
                && felt_mn < contact.least_mn
            {
                seat.want_mn = u16::try_from(share_mn).ok();
            }
        }
    }

    /// What happened, the oldest first.
    pub fn next_report(&mut self) -> Option<Report> {
        self.reports.pop_front()
    }

    /// The last answer of a finger, None while it is lost. Fingers count from 0 on.
    #[must_use]
    pub fn state(&self, finger: usize) -> Option<&State> {
        self.seats.get(finger)?.state.as_ref()
    }

    /// What a finger is wished to press with, mN.
    #[must_use]
    pub fn want_mn(&self, finger: usize) -> Option<u16> {
        self.seats.get(finger)?.want_mn
    }

    /// The forces that were felt last cannot keep all margins below all ceilings: every finger is on its own.
    pub const fn is_lacking(&self) -> bool {
        self.lacking
    }

    /// The longest cycle so far, us, and how many there were.
    pub const fn cycles(&self) -> (u32, u32) {
        (self.longest_us, self.cycles)
    }

    /// The places that it was made with.
    #[must_use]
    pub fn places(&self) -> Places {
        self.seats.iter().map(|seat| seat.place).collect()
    }

    /// Whether a finger that answers holds something.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.seats.iter().any(|seat| seat.felt().is_some())
    }

    /// A byte for a finger's line; false if too many wait.
    pub fn line_byte(&mut self, finger: usize, byte: u8) -> bool {
        self.seats.get_mut(finger).is_some_and(|seat| seat.line.push_back(byte).is_ok())
    }
}

/// A frame behind a zero, which ends whatever garbled bytes came before it.
fn frame(number: u16, address: u8, word: Word, out: &mut [u8]) -> Option<usize> {
    let (first, rest) = out.split_first_mut()?;
    *first = 0;
    Some(1 + encode(number, &Packet { address, word }, rest)?.len())
}
