//! Both receivers under random and mutated bytes: no panic, nothing accepted that was not sent, and in step again with the
//! first frame after a zero.

use serde::Serialize;
use serde::de::DeserializeOwned;
use tenax_hal_shim::channel::{COUNT, PVDF_COUNT};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{Answer, Counters, Down, FRAME_MAX, Raw, Receiver, Senses, Setting, Up, encode};

/// xorshift64*: any bytes will do, the same each time.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() >> 33) as usize % n
    }
}

/// What was sent and what came of it.
#[derive(Debug, Default)]
struct Tally {
    bytes: usize,
    /// Whole frames, each after a zero.
    sent: usize,
    accepted: usize,
    wrong: usize,
    lost: usize,
}

fn fuzz<T: Serialize + DeserializeOwned>(seed: u64, bytes: usize, messages: &[T]) -> Tally {
    let (mut random, mut receiver, mut tally) = (Random(seed), Receiver::new(), Tally::default());
    let mut sequence = 0_u16;
    while tally.bytes < bytes {
        sequence = sequence.wrapping_add(1);
        let mut buffer = [0; FRAME_MAX];
        let whole =
            encode(sequence, &messages[random.below(messages.len())], &mut buffer).expect("it fits").to_vec();
        let mut sent = whole.clone();
        let is_whole = match random.below(6) {
            0 => {
                sent = (0..random.below(700)).map(|_| random.next() as u8).collect();
                false
            }
            1 => {
                for _ in 0..=random.below(4) {
                    let at = random.below(sent.len());
                    sent[at] ^= 1 << random.below(8);
                }
                sent == whole
            }
            2 => {
                sent.truncate(random.below(sent.len()));
                false
            }
            3 => {
                sent.insert(random.below(sent.len()), random.next() as u8);
                false
            }
            4 => {
                // Two of them run into each other: the first is whole, and may be heard.
                sent.pop();
                sent.extend_from_slice(&whole);
                false
            }
            _ => true,
        };
        if !is_whole {
            sent.push(0);
        }
        tally.sent += usize::from(is_whole);
        let mut heard = 0;
        for byte in &sent {
            if let Some(Ok(received)) = receiver.push::<T>(*byte) {
                heard += 1;
                // What is accepted has to be the frame that was made, with its number.
                let mut again = [0; FRAME_MAX];
                let same = encode(received.sequence, &received.message, &mut again)
                    .is_some_and(|again| *again == whole);
                tally.wrong += usize::from(!same);
            }
        }
        tally.bytes += sent.len();
        tally.accepted += heard;
        tally.lost += usize::from(is_whole && heard == 0);
    }
    tally
}

fn both(bytes: usize) {
    let down = [
        Down::Ping,
        Down::Drive { drive: MotorDrive::Open(Duty::FULL), hold_ms: 250 },
        Down::Set(Setting { id: 1, value: 120 }),
        Down::Stream { raw: true, senses: true, hold_s: 9 },
    ];
    let up = [
        Up::Counters(Counters { frames: 9, ..Counters::default() }),
        Up::Answer { of: 7, frame: 9, answer: Answer::Done },
        Up::Raw(Raw::default()),
        Up::Senses(Senses { frame: 24, samples: [8_191; COUNT], films: [40; PVDF_COUNT] }),
    ];
    for seed in [0x5EED_0001, 0x5EED_0002] {
        for tally in [fuzz(seed, bytes / 2, &down), fuzz(seed, bytes / 2, &up)] {
            println!("seed {seed:#x}: {tally:?}");
            assert!(tally.sent > bytes / 10_000, "{tally:?}");
            assert_eq!((tally.wrong, tally.lost), (0, 0), "seed {seed:#x}: {tally:?}");
        }
    }
}

/// A million bytes; `TENAX_FUZZ_BYTES=100000000 cargo test --release -p tenax-hal-shim --test fuzz` takes a quarter of a minute.
// Shows L5.
#[test]
fn garbage_at_each_end_is_counted_and_no_whole_frame_is_lost() {
    let asked = std::env::var("TENAX_FUZZ_BYTES").ok();
    both(asked.map_or(1_000_000, |bytes| bytes.parse().expect("TENAX_FUZZ_BYTES is a number")));
}
