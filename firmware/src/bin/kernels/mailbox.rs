//! Memory that the host writes and reads while the core stands still at [`tenax_kernels_next`](crate::stand::tenax_kernels_next).

use core::sync::atomic::{AtomicI32, AtomicU16, AtomicU32, Ordering::Relaxed};

use tenax_logic::array::{ArrayVerdict, ELEMENTS, FEATURES, Reading};

use crate::Detector;

/// In place of the reading of an element that has none.
const NO_READING: u16 = u16::MAX;

/// Orders from the host: forget all that was read before.
const FORGET: u32 = 1;
/// Orders from the host: run every kernel, not the detector only.
const EVERYTHING: u32 = 2;

/// From the host: what to do with the reading.
#[unsafe(no_mangle)]
static TENAX_KERNELS_ORDERS: AtomicU32 = AtomicU32::new(FORGET);
/// From the host: one reading.
#[unsafe(no_mangle)]
static TENAX_KERNELS_READING: [AtomicU16; ELEMENTS] = [const { AtomicU16::new(NO_READING) }; ELEMENTS];
/// To the host: what the detector says, as [`verdict_bits`] packs it.
#[unsafe(no_mangle)]
static TENAX_KERNELS_VERDICT: AtomicU32 = AtomicU32::new(0);
/// To the host: whether there was a logit, and which.
#[unsafe(no_mangle)]
static TENAX_KERNELS_JUDGED: AtomicU32 = AtomicU32::new(0);
#[unsafe(no_mangle)]
static TENAX_KERNELS_LOGIT: AtomicI32 = AtomicI32::new(0);
/// To the host: the features that the logit is of.
#[unsafe(no_mangle)]
static TENAX_KERNELS_FEATURES: [AtomicU16; FEATURES] = [const { AtomicU16::new(0) }; FEATURES];

/// What the host asks for.
pub struct Orders {
    pub forget: bool,
    pub everything: bool,
}

pub fn orders() -> Orders {
    let orders = TENAX_KERNELS_ORDERS.load(Relaxed);
    Orders { forget: orders & FORGET != 0, everything: orders & EVERYTHING != 0 }
}

pub fn reading() -> Reading {
    core::array::from_fn(|n| {
        let sample = TENAX_KERNELS_READING[n].load(Relaxed);
        (sample != NO_READING).then_some(sample)
    })
}

pub fn answer(detector: &Detector, verdict: ArrayVerdict) {
    for (to, &feature) in TENAX_KERNELS_FEATURES.iter().zip(detector.features()) {
        to.store(feature as u16, Relaxed);
    }
    TENAX_KERNELS_JUDGED.store(u32::from(detector.logit().is_some()), Relaxed);
    TENAX_KERNELS_LOGIT.store(detector.logit().unwrap_or(0), Relaxed);
    TENAX_KERNELS_VERDICT.store(verdict_bits(verdict), Relaxed);
}

/// Age in the upper half, slip in bit 15, confidence below.
fn verdict_bits(verdict: ArrayVerdict) -> u32 {
    u32::from(verdict.age_ms) << 16 | u32::from(verdict.slip) << 15 | u32::from(verdict.confidence_permille)
}

/// All that the array costs in a slow frame.
#[inline(never)]
#[unsafe(no_mangle)]
pub fn tenax_kernel_slow_frame(detector: &mut Detector, reading: &Reading) -> ArrayVerdict {
    detector.push(reading)
}
