//! The last seconds of telemetry, in RAM that a reset does not clear: after a fault they stay until a client has read them.
//! Only telemetry writes it. A frame that a reset cuts short has a wrong CRC; the count of bytes is raised after they are written. A power
//! cut leaves nothing.
//! Runs in telemetry (thread), in control (2) where a command reads it, and in whoever fails. Owns its RAM. Never formats, never waits.

use core::mem::MaybeUninit;
use core::num::NonZeroU32;
use core::ptr::{addr_of, addr_of_mut, copy_nonoverlapping};
use core::slice::from_raw_parts;

use tenax_hal_shim::wire::{Answer, PIECE_MAX, Up, WHY_MAX};
use tenax_hal_shim::words::Fault;

/// Bytes that are kept: three seconds of a hand at rest.
const SIZE: usize = 48 * 1024;
const _: () = assert!(SIZE <= u16::MAX as usize);
/// The header is this image's, not what RAM held when it was switched on.
const SEAL: u32 = 0x7E4A_B0C5;
/// Faults that end a run; the header holds the index plus one.
const FAULTS: [Fault; 5] = [
    Fault::PanicReset,
    Fault::WatchdogReset,
    Fault::SupplySagged,
    Fault::CrystalLost,
    Fault::TooManyRestarts,
];

/// Words of the header: the seal; bytes written since the box was empty; a fault's number or 0; the length of why the run ended.
const SEALED: usize = 0;
const WRITTEN: usize = 1;
const FAULT: usize = 2;
const WHY_LENGTH: usize = 3;

/// Not initialised by the runtime, so that a reset leaves it.
#[unsafe(link_section = ".uninit.black_box")]
static mut HEADER: MaybeUninit<[u32; 4]> = MaybeUninit::uninit();
#[unsafe(link_section = ".uninit.black_box")]
static mut BYTES: MaybeUninit<[u8; SIZE]> = MaybeUninit::uninit();
#[unsafe(link_section = ".uninit.black_box")]
static mut WHY: MaybeUninit<[u8; WHY_MAX]> = MaybeUninit::uninit();

/// A run begins, `after` a fault or not. Asked once, before anything else is running. `was_off`: RAM holds nothing.
pub fn start(after: Option<Fault>, was_off: bool) {
    if was_off || header(SEALED) != SEAL {
        empty();
        set_header(SEALED, SEAL);
    }
    if header(FAULT) != 0 {
        // The first fault of a row is the one to look at.
        return;
    }
    match FAULTS.iter().position(|fault| Some(*fault) == after) {
        Some(number) => set_header(FAULT, number as u32 + 1),
        None => empty(),
    }
}

/// Appends to the reason of the run's end; called last, with all interrupts off. Text beyond [`WHY_MAX`] is cut off.
pub fn why(text: &[u8]) {
    // The first fault of a row has its own.
    if header(SEALED) != SEAL || header(FAULT) != 0 {
        return;
    }
    let mut length = header(WHY_LENGTH) as usize;
    for &byte in text {
        if length < WHY_MAX {
            // SAFETY: within it; nobody else is running.
            unsafe { addr_of_mut!(WHY).cast::<u8>().add(length).write_volatile(byte) };
            length += 1;
        }
    }
    set_header(WHY_LENGTH, length as u32);
}

/// Appends a number below 100 000. Core's formatting can panic.
pub fn why_decimal(number: u32) {
    const POWERS: [NonZeroU32; 5] = [power(10_000), power(1_000), power(100), power(10), power(1)];
    let mut rest = number;
    for power in POWERS {
        let digit = rest / power;
        rest -= digit * power.get();
        if number >= power.get() {
            why(&[b'0' + digit as u8]);
        }
    }
}

const fn power(of_ten: u32) -> NonZeroU32 {
    NonZeroU32::new(of_ten).expect("not zero")
}

pub fn why_hex(address: u32) {
    for nibble in (0..8).rev().map(|n| (address >> (4 * n)) as u8 & 0xF) {
        why(&[nibble + if nibble < 10 { b'0' } else { b'a' - 10 }]);
    }
}

/// Telemetry sends a message as this frame.
pub fn write(message: &Up, frame: &[u8]) {
    // Frames as they were sampled would leave room for a third of a second, and answers are told to whoever asked.
    if header(FAULT) != 0 || matches!(message, Up::Raw(_) | Up::Answer { .. }) || frame.len() > SIZE {
        return;
    }
    let written = header(WRITTEN);
    let at = written as usize % SIZE;
    let first = frame.len().min(SIZE - at);
    let bytes = addr_of_mut!(BYTES).cast::<u8>();
    // SAFETY: `at + first` and what is left are within the box, as is checked above. While it stands open nobody but this
    // task gets at the bytes: `read` looks at a closed one only.
    unsafe {
        copy_nonoverlapping(frame.as_ptr(), bytes.add(at), first);
        copy_nonoverlapping(frame.as_ptr().add(first), bytes, frame.len() - first);
    }
    set_header(WRITTEN, next(written, frame.len()));
}

/// Bytes written after `more`, which go round in the box: their number stays one of a box that is full.
fn next(written: u32, more: usize) -> u32 {
    let next = written.wrapping_add(more as u32);
    if next >= 2 * SIZE as u32 { next - SIZE as u32 } else { next }
}

/// Puts what is kept into the answer to who asked for it. Who asks from the end on has read it all: the box is open again.
pub fn read(answer: &mut Up) {
    let Up::Answer { answer: Answer::Last(last), .. } = answer else { return };
    let after = (header(FAULT) as usize).checked_sub(1).and_then(|number| FAULTS.get(number));
    let Some(&after) = after else { return };
    let written = header(WRITTEN) as usize;
    let length = written.min(SIZE);
    let from = usize::from(last.from);
    if from >= length {
        empty();
        return;
    }
    last.after = Some(after);
    last.length = length as u16;
    let at = (written - length + from) % SIZE;
    let count = (length - from).min(PIECE_MAX);
    let first = count.min(SIZE - at);
    let bytes = addr_of!(BYTES).cast::<u8>();
    // SAFETY: `at + first` and what is left are within the box, and were written, for at least `length` bytes were; nobody
    // writes while it is closed.
    let (one, two) = unsafe { (from_raw_parts(bytes.add(at), first), from_raw_parts(bytes, count - first)) };
    // It has room for both.
    let _fits = last.bytes.extend_from_slice(one);
    let _fits = last.bytes.extend_from_slice(two);
    let _fits = last.why.extend_from_slice(reason());
}

/// Why the run before the box was closed ended; nothing in an open one.
pub fn reason() -> &'static [u8] {
    let length = if header(FAULT) == 0 { 0 } else { (header(WHY_LENGTH) as usize).min(WHY_MAX) };
    // SAFETY: so many were written; nobody writes any more.
    unsafe { from_raw_parts(addr_of!(WHY).cast::<u8>(), length) }
}

fn empty() {
    set_header(WRITTEN, 0);
    set_header(WHY_LENGTH, 0);
    set_header(FAULT, 0);
}

fn header(word: usize) -> u32 {
    // SAFETY: an aligned word in it, and any bits are a u32.
    unsafe { addr_of!(HEADER).cast::<u32>().add(word).read_volatile() }
}

fn set_header(word: usize, value: u32) {
    // SAFETY: an aligned word in it, written whole. Two never write at once: telemetry only while the box is open, control
    // only while it is closed.
    unsafe { addr_of_mut!(HEADER).cast::<u32>().add(word).write_volatile(value) }
}
