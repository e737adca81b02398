//! Places of the bridge's edges between the films' samplings.
//!
//! An edge makes ground and reference jump for some tenths of a microsecond, and a film whose sampling ends then is converted with it. A
//! scan lasts 2.5 periods of the bridge, so every other one sees the edges 25 us later: modulo 25 us they keep their place. The falling
//! edge's depends on the pulse of the side that is switched. So each pulse has a place of its own for the rising one, at which both come 0.86 us or more before the next
//! end of a sampling, and 0.2 us or more after the last: the counter is moved when the pulse changes, by 5.4 us at most.
//! Runs in control (2), interrupts off for some instructions. Owns nothing: moves TIM1's counter, reads TIM3's.

use embassy_stm32::pac::{TIM1, TIM3};
use tenax_hal_shim::channel::PVDF_COUNT;

use crate::timing::PWM_TICKS;

/// Two scans see the edges this many ticks apart.
const HALF: u32 = PWM_TICKS as u32 / 2;
/// From the scans' trigger to the first film's end of sampling, 56 cycles at 25 MHz, and from one to the next, 12 more.
const SAMPLED: u32 = 224;
const RANK: u32 = 272;
/// The rising edge's earliest place after the trigger: the conversion of the fifth film.
const FIRST: u32 = 1_090;
/// Places are so far apart, and there are so many.
const STEP: u32 = 10;
const STEPS: u8 = 55;
/// Pulses that share a place differ by less, ticks.
const BUCKET: u32 = 20;
/// From a reading of the bridge's counter to its writing: instructions of a cycle, and the bus.
const WRITTEN: u32 = 11;
/// Least room before an end of a sampling, and after one, ticks.
const BEFORE: i32 = 75;
const AFTER: i32 = 10;

/// Place of the rising edge for each bucket of pulses, modulo [`HALF`], in steps from [`FIRST`].
static PLACES: [u8; (HALF / BUCKET) as usize] = {
    let mut places = [0; (HALF / BUCKET) as usize];
    let mut bucket = 0;
    while bucket < places.len() {
        let (mut step, mut best) = (0, i32::MIN);
        while step < STEPS {
            let rises = FIRST + STEP * step as u32;
            let falls = rises + BUCKET * bucket as u32;
            let room = least(room(rises), least(room(falls), room(falls + BUCKET)));
            if room > best {
                (best, places[bucket]) = (room, step);
            }
            step += 1;
        }
        assert!(best >= 0, "each pulse has a place");
        bucket += 1;
    }
    places
};

/// Room of an edge between the samplings' ends beyond the least, ticks.
const fn room(edge: u32) -> i32 {
    let (mut film, mut room) = (0, i32::MAX);
    while film < PVDF_COUNT as u32 {
        let before = (SAMPLED + RANK * film + 2 * HALF - edge % HALF) % HALF;
        room = least(room, least(before as i32 - BEFORE, (HALF - before) as i32 - AFTER));
        film += 1;
    }
    room
}

const fn least(a: i32, b: i32) -> i32 {
    if a < b { a } else { b }
}

/// Moves the edges to where a pulse of so many ticks has them: the next samplings are tens of microseconds away.
#[inline(never)]
pub fn place(pulse: u16) {
    let bucket = u32::from(pulse) % HALF / BUCKET;
    let Some(&step) = PLACES.get(bucket as usize) else { return };
    let rises = FIRST + STEP * u32::from(step);
    cortex_m::interrupt::free(|_| {
        let since_trigger = u32::from(TIM3.cnt().read().cnt());
        let count = u32::from(TIM1.cnt().read().cnt());
        // Where it should stand, of the two half periods the nearer one.
        let behind = (since_trigger + WRITTEN + 4 * HALF - rises - count) % HALF;
        let ahead = if behind > HALF / 2 { behind + HALF } else { behind };
        let moved = u32::from(TIM1.cnt().read().cnt()) + ahead;
        TIM1.cnt().write(|w| w.set_cnt((if moved < 2 * HALF { moved } else { moved - 2 * HALF }) as u16));
    });
}
