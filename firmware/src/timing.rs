//! Every time of the image, with what it follows from. Constants alone: no priority, no owner.

use core::ops::RangeInclusive;

use tenax_hal_shim::channel::{FRAME_HZ, SCAN_HZ, SCAN_LEN, SCANS_PER_FRAME, SLOW_HZ};
use tenax_hal_shim::motor::Duty;
use tenax_hal_shim::wire::BAUD;

/// Clock of AHB and all timers, Hz (RM0383, figure 12).
pub const CORE_HZ: u32 = 100_000_000;
/// A crystal of 8 MHz or the chip's own of 16 MHz, divided to this, Hz, and multiplied by 100 before the PLL halves it.
const PLL_HZ: u32 = 2_000_000;
const _: () = assert!(PLL_HZ * 100 / 2 == CORE_HZ);

/// Both motors' PWM, above hearing: a whole number of the timer's ticks for each per mille.
pub const PWM_HZ: u32 = 20_000;
pub const PWM_TICKS: u16 = (CORE_HZ / PWM_HZ) as u16;
pub const TICKS_PER_MILLE: u16 = PWM_TICKS / Duty::FULL.as_per_mille();
const _: () = assert!(TICKS_PER_MILLE * Duty::FULL.as_per_mille() == PWM_TICKS);
// A scan is 2.5 of the bridge's periods, so its edges keep their place between the films' samplings (`bridge/edges.rs`).
const _: () = assert!(2 * CORE_HZ / SCAN_HZ == 5 * PWM_TICKS as u32);

pub const SCAN_US: u32 = 1_000_000 / SCAN_HZ;
pub const FRAME_US: u32 = 1_000_000 / FRAME_HZ;
const _: () = assert!(CORE_HZ.is_multiple_of(SCAN_HZ) && SCAN_US * SCAN_HZ == 1_000_000);
const _: () = assert!(FRAME_US == SCANS_PER_FRAME as u32 * SCAN_US);
/// From a scan's trigger to its last code: 56 + 12 cycles of 25 MHz for each input (RM0383, section 11.12).
const SCAN_LASTS_US: u32 = (SCAN_LEN as u32 * (56 + 12)).div_ceil(25);
/// From a frame's last code to the next frame: the select lines step, and what they show settles.
const STEP_US: u32 = SCAN_US - SCAN_LASTS_US;
const _: () = assert!(STEP_US >= 86);
/// A frame that is this late is not waited for any more: the switches have begun to show the following one.
pub const PATIENCE_US: u32 = SCAN_US;

/// Looks at a stream that was stopped, of two cycles or more: a transfer takes some ten (AN4031).
pub const STREAM_LOOKS: u32 = 100;

/// Programming a word stalls the core for so long at most (DS10314, flash memory programming).
const WORD_US: u32 = 100;
/// A word begins at most so long after a tick's end; the tick itself ends within a scan.
pub const WORD_BEGINS_US: u32 = 250;
const _: () = assert!(SCAN_US + WORD_BEGINS_US + WORD_US < FRAME_US);
/// Ticks from one word to the next: the network's 78 words take 0.16 s, and the serial line keeps its share of the core.
pub const TICKS_PER_WORD: u32 = 4;

/// Bytes that DMA writes around in, and how long a full line takes for half of them: who reads them has to have had a turn.
pub const RING_LEN: usize = 768;
const HALF_RING_US: u32 = (RING_LEN as u64 / 2 * 10 * 1_000_000 / BAUD as u64) as u32;
/// Telemetry's longest message, 18 000 instructions of two cycles each, with control's share beside.
const MESSAGE_US: u32 = 360 + SCAN_US;
const _: () = assert!(HALF_RING_US > 4 * MESSAGE_US);
/// What telemetry does ten times a second.
pub const BEAT_US: u32 = 100_000;

/// Rate of the watchdog's oscillator, kHz, of which embassy supposes 32 (DS10314, LSI oscillator characteristics).
const LSI_KHZ: RangeInclusive<u32> = 17..=47;
/// The watchdog's periods: for a start, and while control runs, which feeds it once a frame.
pub const START_US: u32 = 8_000_000;
pub const CONTROL_US: u32 = 100_000;
/// The longest of a start that nobody feeds it in: a sector erased by bytes, of 128 KiB.
const ERASE_US: u32 = 4_000_000;
const _: () = assert!(START_US / *LSI_KHZ.end() * 32 > ERASE_US);
const _: () = assert!(START_US / *LSI_KHZ.end() * 32 > LOOK_US * (SUPPLY_LOOKS + CRYSTAL_LOOKS + 4 * LOOKS));
// A hang leaves the motor driven for 0.19 s at most (docs/safety.md, H25).
const _: () = assert!(CONTROL_US / *LSI_KHZ.start() * 32 < 190_000 && CONTROL_US > 100 * FRAME_US);

/// One look at supply, crystal or PLL: 0.1 ms at 16 MHz.
pub const LOOK_CYCLES: u32 = 16_000_000 / LOOKS_PER_S;
const LOOKS_PER_S: u32 = 10_000;
const LOOK_US: u32 = 1_000_000 / LOOKS_PER_S;
/// A crystal takes 2 ms (DS10314, HSE oscillator characteristics), the PLL 0.3 ms, the ST-LINK's clock goes on through a reset: 20 ms.
pub const LOOKS: u32 = LOOKS_PER_S / 50;
/// Where the supply has been off, the ST-LINK starts as well: 0.3 s.
pub const CRYSTAL_LOOKS: u32 = 3 * LOOKS_PER_S / 10;
/// A battery behind a regulator takes some ms: 1 s.
pub const SUPPLY_LOOKS: u32 = LOOKS_PER_S;
/// From one look at a supply that is low to the next, while the line is served.
pub const SUPPLY_LOOK_US: u32 = 10_000;

/// Slow frames after which a restart is not one of a row any more: ten seconds.
pub const LIVED_WELL: u16 = 10 * SLOW_HZ as u16;
