//! What comes over the bus that is none of the palm's: nothing is wished by it, and a finger that was pushed off comes back.

use proptest::prelude::Rng;
use proptest::test_runner::{RngAlgorithm, TestRng};
use tenax_hal_shim::wire::encode;
use tenax_palm::bus::{ALL, CYCLE_US, Chip, FRAME_MAX, Packet, Poll, State, Word, bytes_us};
use tenax_palm::finger::Finger;
use tenax_palm::palm::{Palm, Report};
use tenax_palm::places::Place;

const CHIPS: [Chip; 2] = [[1, 2, 3], [4, 5, 6]];
/// A frame that has come and gone is taken as this long, us.
const FRAME_US: u32 = bytes_us(60);

/// A palm and two fingers, frame by frame.
struct Hand {
    palm: Palm,
    fingers: [Finger; 2],
    now_us: u32,
    /// What the palm said last.
    said: Vec<u8>,
}

impl Hand {
    fn new() -> Self {
        let place = |chip| Place { chip, normal: [1_000, 0], ceiling_mn: 40_000 };
        Self {
            palm: Palm::new(&CHIPS.map(place), 0),
            fingers: CHIPS.map(Finger::new),
            now_us: 0,
            said: Vec::new(),
        }
    }

    /// The palm's next step, and what the fingers answer to it, one after the other.
    fn step(&mut self) {
        let mut out = [0; FRAME_MAX];
        let length = self.palm.step(self.now_us, &mut out);
        self.now_us += bytes_us(length as u32).max(10);
        if length > 0 {
            self.said = out[..length].to_vec();
            let said = self.said.clone();
            for answer in self.tell(&said) {
                self.now_us += FRAME_US;
                answer.iter().for_each(|&byte| _ = self.palm.hear(byte, self.now_us));
            }
        }
    }

    /// All fingers hear it.
    fn tell(&mut self, bytes: &[u8]) -> Vec<Vec<u8>> {
        let mut answers = Vec::new();
        for finger in &mut self.fingers {
            let mut out = [0; FRAME_MAX];
            for &byte in bytes {
                if let Some(answer) = finger.hear(byte, self.now_us, &mut out) {
                    answers.push(out[..answer.length].to_vec());
                }
            }
        }
        answers
    }

    /// Until both fingers answer.
    fn gather(&mut self) {
        let from_us = self.now_us;
        while (0..2).any(|n| self.palm.state(n).is_none()) {
            self.step();
            assert!(self.now_us - from_us < 300_000, "{:?}", self.palm.state(0));
        }
        // Their clocks follow.
        let from_us = self.now_us;
        while self.now_us - from_us < 4 * CYCLE_US {
            self.step();
        }
    }
}

fn wish(address: u8, number: u16, stamp_us: u32) -> Vec<u8> {
    let poll = Poll { stamp_us, want_mn: Some(30_000), slips: 3, ..Poll::default() };
    encode(number, &Packet { address, word: Word::Poll(poll) }, &mut [0; FRAME_MAX]).unwrap().to_vec()
}

/// A frame of somebody who knows the format: any packet, any number.
fn made_up(random: &mut TestRng) -> Vec<u8> {
    let (number, four) = (random.next_u32() as u16, random.next_u32());
    let address = (four % 8) as u8;
    let chip = CHIPS[four as usize / 8 % 2];
    let word = match four / 16 % 6 {
        0 => Word::Claim { round: number as u8, slots: (four >> 24) as u8 },
        1 => Word::Here { chip, nonce: random.next_u32() },
        2 => Word::Assign { chip, nonce: random.next_u32() },
        3 => Word::State(State { frame: four, ..State::default() }),
        4 if four % 512 == 0 => Word::Release,
        _ => return wish(address, number, random.next_u32()),
    };
    encode(number, &Packet { address, word }, &mut [0; FRAME_MAX]).unwrap().to_vec()
}

/// So many frames of any kind among the palm's own; the fingers are there again after them.
fn attack(frames: u32) {
    let mut random = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let mut hand = Hand::new();
    hand.gather();
    let mut kept = vec![hand.said.clone()];
    for n in 0..frames {
        let mut bytes = match n % 4 {
            0 => {
                let mut bytes = vec![0; random.next_u32() as usize % 80];
                random.fill_bytes(&mut bytes);
                bytes
            }
            1 => made_up(&mut random),
            // As it was, some time ago, or with one bit another.
            _ => kept[random.next_u32() as usize % kept.len()].clone(),
        };
        if n % 4 == 3 {
            let at = random.next_u32() as usize;
            if let Some(byte) = bytes.get_mut(at / 8 % 60) {
                *byte ^= 1 << (at % 8);
            }
        }
        bytes.push(0);
        for answer in hand.tell(&bytes) {
            answer.iter().for_each(|&byte| _ = hand.palm.hear(byte, hand.now_us));
        }
        bytes.iter().for_each(|&byte| _ = hand.palm.hear(byte, hand.now_us));
        for finger in &hand.fingers {
            assert_eq!((finger.want_mn(), finger.neighbours()), (None, 0), "frame {n}");
        }
        if n % 8 == 0 {
            hand.step();
            if kept.len() < 1_000 {
                kept.push(hand.said.clone());
            }
        }
    }
    // A second for those that were cut off.
    let from_us = hand.now_us;
    while hand.now_us.wrapping_sub(from_us) < 1_500_000 {
        hand.step();
    }
    hand.gather();
}

// Shows L7.
#[test]
fn ten_million_frames_of_nobody_wish_for_nothing() {
    attack(10_000_000);
}

// Shows L7.
#[test]
fn a_wish_is_heard_with_its_number_and_its_time_and_not_again() {
    let mut hand = Hand::new();
    hand.gather();
    let heard = |hand: &mut Hand, bytes: &[u8]| {
        let answers = hand.tell(bytes).len();
        (answers, hand.fingers[0].want_mn())
    };
    let address = hand.fingers[0].address();
    // The palm's next numbers are not this far on; the time has to be right.
    let now_us = hand.now_us - bytes_us(26);
    let right = wish(address, 500, now_us);
    assert_eq!(heard(&mut hand, &wish(address, 499, now_us + 5_000)), (1, None), "another time");
    assert_eq!(heard(&mut hand, &wish(address, 400, now_us)), (0, None), "a number of before");
    assert_eq!(heard(&mut hand, &wish(address + 2, 500, now_us)), (0, None), "somebody else's");
    assert_eq!(heard(&mut hand, &right), (1, Some(30_000)), "the control");
    assert_eq!(heard(&mut hand, &wish(address, 501, now_us + 5_000)), (1, None));
    assert_eq!(heard(&mut hand, &right), (0, None), "recorded and said again");
}

#[test]
fn a_finger_that_speaks_unasked_is_cut_off_for_a_second() {
    let mut hand = Hand::new();
    hand.gather();
    while hand.palm.next_report().is_some() {}
    let address = hand.fingers[1].address();
    let word = Word::State(State::default());
    let babble = encode(1, &Packet { address, word }, &mut [0; FRAME_MAX]).unwrap().to_vec();
    for _ in 0..3 {
        // In the silence after a cycle.
        (0..40).for_each(|_| hand.step());
        [&[0][..], &babble].concat().iter().for_each(|&byte| _ = hand.palm.hear(byte, hand.now_us));
    }
    assert_eq!(hand.palm.next_report(), Some(Report::Cut(address)));
    let from_us = hand.now_us;
    while hand.now_us - from_us < 900_000 {
        hand.step();
        assert_eq!(hand.palm.state(usize::from(address) - 1), None);
    }
    hand.gather();
    assert_ne!(address, ALL);
}

#[test]
fn numbers_that_come_round_open_another_session_without_a_loss() {
    let mut hand = Hand::new();
    hand.gather();
    while hand.palm.next_report().is_some() {}
    let from_us = hand.now_us;
    // 500 polls a second use the numbers up in 127 s.
    while hand.now_us - from_us < 300_000_000 {
        hand.step();
        assert_eq!(hand.palm.next_report(), None, "after {} us", hand.now_us - from_us);
        assert!(hand.palm.state(0).is_some());
    }
}
