//! Counters of the image, as [`Counters`] has them. Every task adds to its own; telemetry reads them all.
//! Runs anywhere. Owns its counters.

use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

use tenax_hal_shim::wire::Counters;

pub struct Count(AtomicU32);

impl Count {
    const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    pub fn add_one(&self) {
        self.add(1);
    }

    pub fn add(&self, n: u32) {
        self.0.fetch_add(n, Relaxed);
    }

    pub fn max(&self, n: u32) {
        self.0.fetch_max(n, Relaxed);
    }

    fn get(&self) -> u32 {
        self.0.load(Relaxed)
    }
}

pub static FRAMES: Count = Count::new();
pub static FRAMES_LOST: Count = Count::new();
pub static OVERRUNS: Count = Count::new();
pub static TICKS: Count = Count::new();
pub static TICKS_LATE: Count = Count::new();
pub static TELEMETRY_DROPPED: Count = Count::new();
pub static BAD_FRAMES: Count = Count::new();
pub static COMMANDS_SKIPPED: Count = Count::new();

/// Execution time of control since boot, us; wraps at 2^32.
pub static CONTROL_US: Count = Count::new();
/// Longest execution for one frame since boot, us.
pub static CONTROL_US_MAX: Count = Count::new();

/// Sequence number of the last frame that had its tick.
pub fn last_frame() -> u32 {
    TICKS.get().wrapping_sub(1)
}

pub fn control_us() -> u32 {
    CONTROL_US.get()
}

pub fn counters(control_permille: u16) -> Counters {
    Counters {
        frames: FRAMES.get(),
        frames_lost: FRAMES_LOST.get(),
        overruns: OVERRUNS.get(),
        ticks: TICKS.get(),
        ticks_late: TICKS_LATE.get(),
        telemetry_dropped: TELEMETRY_DROPPED.get(),
        bad_frames: BAD_FRAMES.get(),
        commands_skipped: COMMANDS_SKIPPED.get(),
        control_us_max: CONTROL_US_MAX.get(),
        control_permille,
    }
}
