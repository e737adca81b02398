//! A finger's end of the bus: it answers polls, follows the palm's clock, and warns its own reflex where the palm wishes for more force.

use heapless::{Deque, Vec};
use tenax_hal_shim::channel::frames;
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::wire::{Receiver, Refusal, Up, encode};
use tenax_hal_shim::words::GripMode;
use tenax_logic::detectors::Said;
use tenax_logic::fingertip::Fingertip;
use tenax_logic::session::Session;

use crate::bus::{
    ALL, CLAIM_SLOT_US, CYCLE_US, Chip, FRAME_MAX, Felt, LINE_DOWN, MISSED_MAX, Packet, Poll, State, Word,
    bytes_us,
};
use crate::clock::Clock;

/// A wish is void so long after the poll that brought it, us.
const WISH_US: u32 = (MISSED_MAX as u32 + 1) * CYCLE_US;
/// Without a poll for so long a finger has no address any more, us: another palm may come.
const FORGETS_US: u32 = 100_000;
/// How long the palm's warnings may close a finger in all, frames: as long as the blind may. A muscle, or an object let go, renews it.
const BUDGET_FRAMES: u32 = frames(200);
/// So many pulses that raised nothing end the wish until the load changes: after more, the reflex would not answer its own warnings either.
const TRIES_MAX: u8 = 4;
/// A load below this is let go, mN. Where there is no load or no ratio, nobody knows: a sensor that comes and goes renews nothing.
const LET_GO_MN: i32 = 150;
/// The part of a load by which it has changed.
const CHANGED_PART: u16 = 100;
/// A wish that is no further above the load is fulfilled, mN: the force sensor's noise.
const NEAR_MN: i32 = 50;
/// Bytes that tell whom a frame concerns: two counts' places, version, number, address, word.
const HEAD: usize = 7;
/// The words' places in their list that a finger need not decode.
const HERE: u8 = 1;
const POLL: u8 = 4;
const STATE: u8 = 5;
/// Bytes of the finger's line that wait.
const LINE_UP_MAX: usize = 2_048;
const LINE_DOWN_MAX: usize = 256;

/// A finger's end of the bus.
#[derive(Debug)]
pub struct Finger {
    chip: Chip,
    address: u8,
    session: Session,
    receiver: Receiver,
    /// Bytes of the frame that comes, and the first of them.
    bytes: u32,
    head: [u8; HEAD],
    number: u16,
    clock: Clock,
    polled_us: u32,
    slips: u8,
    want_mn: Option<u16>,
    left_frames: u32,
    has_let_go: bool,
    /// Pulses that this load has been wished for, mN, and whether one is on.
    tries: u8,
    tried_mn: u16,
    pulses: bool,
    /// The reflex was warned in the last tick.
    warned: bool,
    /// The last tick, and when it was here.
    state: State,
    frame_us: u32,
    line_up: Deque<u8, LINE_UP_MAX>,
    line_down: Deque<u8, LINE_DOWN_MAX>,
    dropped: u32,
}

/// What a finger answers: so many bytes, so long after the question at the earliest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answer {
    /// Bytes that were written.
    pub length: usize,
    /// From the question's end, us.
    pub after_us: u32,
}

impl Finger {
    /// One that nobody has asked yet.
    pub fn new(chip: Chip) -> Self {
        let mut session = Session::default();
        chip.iter().for_each(|&part| session.stir(part));
        Self {
            chip,
            address: ALL,
            session,
            receiver: Receiver::new(),
            bytes: 0,
            head: [0; HEAD],
            number: 0,
            clock: Clock::default(),
            polled_us: 0,
            slips: 0,
            want_mn: None,
            left_frames: BUDGET_FRAMES,
            has_let_go: false,
            tries: 0,
            tried_mn: 0,
            pulses: false,
            warned: false,
            state: State::default(),
            frame_us: 0,
            line_up: Deque::new(),
            line_down: Deque::new(),
            dropped: 0,
        }
    }

    /// Another chip with the same address and numbers: what a fault makes of two fingers. For tests.
    #[must_use]
    pub fn twin(&self, chip: Chip) -> Self {
        Self {
            address: self.address,
            session: self.session.clone(),
            polled_us: self.polled_us,
            ..Self::new(chip)
        }
    }

    /// A byte is over at `now_us` by this chip's clock. Some if it asks for an answer, which is in `out` then.
    pub fn hear(&mut self, byte: u8, now_us: u32, out: &mut [u8]) -> Option<Answer> {
        if let Some(place) = self.head.get_mut(self.bytes as usize) {
            *place = byte;
        }
        self.bytes = self.bytes.saturating_add(1).min(2 * FRAME_MAX as u32);
        if byte != 0 {
            // Only a zero ends a frame.
            let _nothing_yet = self.receiver.push::<Packet>(byte);
            return None;
        }
        let bytes = core::mem::take(&mut self.bytes);
        let concerns = concerns(&self.head, self.address);
        let received = self.receiver.push_if::<Packet>(byte, || concerns)?.ok()?;
        let Packet { address, word } = received.message;
        let own = address != ALL && address == self.address;
        match word {
            Word::Claim { round, slots } if self.address == ALL => {
                let slot = self.chip.iter().fold(u32::from(round), |all, &part| {
                    (all ^ part).wrapping_mul(0x9E37_79B9).rotate_left(13)
                });
                Some(self.here(slot % u32::from(slots.max(1)) * CLAIM_SLOT_US, out)?)
            }
            Word::Assign { chip, nonce } if chip == self.chip && address != ALL => {
                if self.session.open(nonce, received.sequence).is_ok() {
                    self.address = address;
                    self.polled_us = now_us;
                }
                None
            }
            Word::Release if own || address == ALL => {
                self.leave();
                None
            }
            Word::Poll(poll) if own => match self.session.admit(received.sequence, false) {
                Ok(()) => self.polled(&poll, now_us, bytes, out),
                // Its numbers have come round: the palm opens another session.
                Err(Refusal::NoSession) => {
                    self.leave();
                    self.here(0, out)
                }
                // Said before: it moves nothing, and is not answered.
                Err(_) => None,
            },
            _ => None,
        }
    }

    fn here(&mut self, after_us: u32, out: &mut [u8]) -> Option<Answer> {
        let word = Word::Here { chip: self.chip, nonce: self.session.offer() };
        self.say(word, after_us, out)
    }

    fn say(&mut self, word: Word, after_us: u32, out: &mut [u8]) -> Option<Answer> {
        self.number = self.number.wrapping_add(1);
        let length = encode(self.number, &Packet { address: self.address, word }, out)?.len();
        Some(Answer { length, after_us })
    }

    fn leave(&mut self) {
        (self.address, self.want_mn, self.slips) = (ALL, None, 0);
        // Another palm begins with whole frames.
        self.line_up.clear();
        self.line_down.clear();
    }

    fn polled(&mut self, poll: &Poll, now_us: u32, bytes: u32, out: &mut [u8]) -> Option<Answer> {
        // A zero came before it. Whoever makes frames up does not know the time: nothing of theirs is wished.
        let knows = self.clock.follow(poll.stamp_us, now_us.wrapping_sub(bytes_us(1 + bytes)));
        self.polled_us = now_us;
        (self.slips, self.want_mn) = if knows { (poll.slips, poll.want_mn) } else { (0, None) };
        // A flood from above finds no room and is cut; what is left of its frames has a wrong CRC.
        poll.line.iter().all(|&byte| self.line_down.push_back(byte).is_ok());
        let mut state = self.state.clone();
        state.frame_at_us = self.clock.palm_us(self.frame_us).unwrap_or_default();
        while !state.line.is_full()
            && let Some(byte) = self.line_up.pop_front()
        {
            // It has room.
            let _fits = state.line.push(byte);
        }
        self.say(Word::State(state), 0, out)
    }

    /// Takes a frame of the finger's line, to be carried up. One that finds no room is dropped whole, and counted.
    pub fn post(&mut self, frame: &[u8]) {
        if self.line_up.capacity() - self.line_up.len() < frame.len() {
            self.dropped = self.dropped.saturating_add(1);
            return;
        }
        frame.iter().all(|&byte| self.line_up.push_back(byte).is_ok());
    }

    /// Frames of its line that were dropped.
    pub const fn dropped(&self) -> u32 {
        self.dropped
    }

    /// The next byte of the finger's line that came down.
    pub fn line_byte(&mut self) -> Option<u8> {
        self.line_down.pop_front()
    }

    /// Takes what the finger says of itself: the forces, 80 times a second.
    pub fn note(&mut self, message: &Up) {
        let Up::Slow(slow) = message else { return };
        self.session.stir(slow.samples_sum);
        let narrow = |mn: i32| mn.clamp(0, u16::MAX.into()) as u16;
        self.has_let_go = slow.forces.is_some_and(|forces| forces.load_mn < LET_GO_MN);
        // Without a ratio it holds nothing worth the name.
        self.state.felt = slow.forces.filter(|forces| forces.ratio_permille.is_some()).map(|forces| Felt {
            load_mn: narrow(forces.load_mn),
            ft_mn: narrow(forces.ft_mn),
            friction_permille: slow.s2_permille,
        });
    }

    /// The fingertip has ticked; its frame ended at `now_us` by this chip's clock. What the palm wishes is said to its reflex.
    pub fn ticked(&mut self, fingertip: &mut Fingertip, now_us: u32) {
        let wearer = fingertip.wearer_active();
        self.frame_us = now_us;
        self.state.frame = fingertip.frame();
        self.state.wearer = wearer;
        self.state.slip = fingertip.slip();
        self.state.incipient = fingertip.incipient();
        let unheard_us = now_us.wrapping_sub(self.polled_us);
        // What was heard within this tick is not late.
        let unheard_us = if unheard_us > u32::MAX / 2 { 0 } else { unheard_us };
        if self.address != ALL && unheard_us > FORGETS_US {
            self.leave();
        } else if unheard_us > WISH_US {
            (self.want_mn, self.slips) = (None, 0);
        }
        if fingertip.wearer_renews() || self.has_let_go {
            self.left_frames = BUDGET_FRAMES;
        }
        let load_mn = self.state.felt.map_or(0, |felt| felt.load_mn);
        if load_mn.abs_diff(self.tried_mn) > self.tried_mn / CHANGED_PART {
            (self.tries, self.tried_mn) = (0, load_mn);
        }
        let lacks = self.want_mn.map(i32::from).filter(|&want_mn| i32::from(load_mn) + NEAR_MN < want_mn);
        let may = self.left_frames > 0 && self.tries < TRIES_MAX && self.state.felt.is_some() && !wearer;
        let wish_mn = lacks.filter(|_| may);
        // Warned in the frame before, it may have begun in this one, and goes on whether it is still wished or not.
        let warned = core::mem::replace(&mut self.warned, wish_mn.is_some());
        let pulses = fingertip.mode() == GripMode::Incipient && (warned || self.pulses || wish_mn.is_some());
        if pulses {
            self.left_frames = self.left_frames.saturating_sub(1);
        } else if core::mem::replace(&mut self.pulses, pulses) {
            self.tries = self.tries.saturating_add(1);
        }
        self.pulses = pulses;
        fingertip.inject(Said { slip: false, incipient: wish_mn.is_some() });
        fingertip.wish(wish_mn);
    }

    /// Its address, [`ALL`] while it has none.
    pub const fn address(&self) -> u8 {
        self.address
    }

    /// The palm's time at an instant of this chip's clock. None before the first poll.
    #[must_use]
    pub fn palm_us(&self, own_us: u32) -> Option<u32> {
        self.clock.palm_us(own_us)
    }

    /// Neighbours whose detectors say slip, a bit for each address from 1 on.
    pub const fn neighbours(&self) -> u8 {
        match self.address {
            ALL => 0,
            address => self.slips & !(1 << (address - 1)),
        }
    }

    /// What the palm wishes this finger's load to be, mN.
    pub const fn want_mn(&self) -> Option<u16> {
        self.want_mn
    }

    /// What it feels, as the palm is told.
    pub const fn felt(&self) -> Option<Felt> {
        self.state.felt
    }

    /// Detectors that say slip here, as the palm is told.
    pub const fn slip(&self) -> DetectorSet {
        self.state.slip
    }
}

/// Whether a frame that begins so may concern a finger of this address. To decode what its neighbours answer would make its own answer
/// later by 50 us. What is garbled is for who decodes it.
fn concerns(head: &[u8; HEAD], own: u8) -> bool {
    // COBS (see `wire`): a count of what comes before the next zero, in whose place the next count stands.
    let mut zero_in = 0u8;
    let mut bytes = head.iter().enumerate().filter_map(|(n, &byte)| {
        zero_in = zero_in.saturating_sub(1);
        if zero_in > 0 {
            return Some(byte);
        }
        zero_in = byte;
        (n > 0).then_some(0)
    });
    let _version = bytes.next();
    // The number, in up to three parts of seven bits.
    let _number = bytes.find(|part| part & 0x80 == 0);
    match (bytes.next(), bytes.next()) {
        (Some(address), Some(POLL)) => address == own,
        (_, Some(HERE | STATE)) => false,
        _ => true,
    }
}

const _: () = assert!(LINE_DOWN < LINE_DOWN_MAX);
/// A line of bytes for a poll.
pub type Line = Vec<u8, LINE_DOWN>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_concerns_whoever_acts_on_it_and_no_neighbour() {
        let words = [
            (Word::Claim { round: 0, slots: 1 }, [true; 2]),
            (Word::Here { chip: [1; 3], nonce: 0 }, [false; 2]),
            (Word::Assign { chip: [0; 3], nonce: 9 }, [true; 2]),
            (Word::Release, [true; 2]),
            (Word::Poll(Poll::default()), [true, false]),
            (Word::State(State::default()), [false; 2]),
        ];
        for (word, expected) in words {
            for number in [0, 1, 127, 128, 256, 16_384, u16::MAX] {
                for address in [ALL, 2] {
                    let mut frame = [0; FRAME_MAX];
                    let packet = Packet { address, word: word.clone() };
                    encode(number, &packet, &mut frame).unwrap();
                    let head = *frame.first_chunk().unwrap();
                    let found = [address, 3].map(|own| concerns(&head, own));
                    assert_eq!(found, expected, "{number} {packet:?}");
                }
            }
        }
    }
}
