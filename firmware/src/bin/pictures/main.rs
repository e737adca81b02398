//! A camera of 160 x 120 pixels on the emulated core: what `tenax-vision` says of each picture, and what that takes.
//!
//! The host puts a picture into memory whenever the core arrives at `tenax_kernels_next`, and finds there, as text, what the core saw
//! in the one before. The heap is the RAM that a chip with a camera port has and this project's chip has not (STM32H743: 512 KiB at
//! 0x2400_0000); stack and variables have as much as in the fingertip. This image drives nothing and is never flashed.
#![no_std]
#![no_main]

extern crate alloc;

#[path = "../kernels/stand.rs"]
mod stand;

use alloc::boxed::Box;
use core::fmt::Write as _;
use core::hint::black_box;
use core::sync::atomic::{AtomicPtr, AtomicU8, AtomicU32, Ordering::Relaxed};

use cortex_m_rt::entry;
use embedded_alloc::LlffHeap;
// Brings the interrupt vectors that the linker's script asks for.
use embassy_stm32 as _;
use heapless::String;
use tenax_vision_quarter::frame::{Frame, plane};
use tenax_vision_quarter::object::Config;
use tenax_vision_quarter::{Camera, Summary};

/// Bytes of what is said of a picture.
const SAID_MAX: usize = 1_536;

#[global_allocator]
static HEAP: LlffHeap = LlffHeap::empty();

/// To the host: where the planes of the next picture go, green, blue, red; null until they are there.
#[unsafe(no_mangle)]
static TENAX_KERNELS_PLANES: [AtomicPtr<u8>; 3] = [const { AtomicPtr::new(core::ptr::null_mut()) }; 3];
/// From the host: when it was taken, ms, and in the lowest bit whether colours are learned.
#[unsafe(no_mangle)]
static TENAX_KERNELS_ORDERS: AtomicU32 = AtomicU32::new(0);
/// To the host: what was seen, as [`Summary`] says it, up to the first 0.
#[unsafe(no_mangle)]
static TENAX_KERNELS_SAID: [AtomicU8; SAID_MAX] = [const { AtomicU8::new(0) }; SAID_MAX];
/// To the host: bytes of the heap that are in use.
#[unsafe(no_mangle)]
static TENAX_KERNELS_HEAP: AtomicU32 = AtomicU32::new(0);

#[entry]
fn main() -> ! {
    // SAFETY: once, before anything is allocated; this RAM is nobody else's, for the linker does not know it.
    unsafe { HEAP.init(0x2400_0000, 512 << 10) };
    let mut camera = Box::new(Camera::new(Config::default()));
    let mut planes = [plane(), plane(), plane()];
    for (at, plane) in TENAX_KERNELS_PLANES.iter().zip(&mut planes) {
        at.store(plane.as_mut_ptr(), Relaxed);
    }
    TENAX_KERNELS_HEAP.store(HEAP.used() as u32, Relaxed);
    loop {
        stand::tenax_kernels_next();
        // The host has written there.
        let [green, blue, red] = black_box(&planes);
        let orders = TENAX_KERNELS_ORDERS.load(Relaxed);
        let frame = Frame { red, green, blue };
        let (learn, taken_ms) = (orders & 1 != 0, orders >> 1);
        answer(&if camera.markers().is_some() {
            tenax_kernel_picture(&mut camera, &frame, learn, taken_ms)
        } else {
            // The markers are looked for, which takes longer.
            camera.picture(&frame, learn, taken_ms, taken_ms)
        });
    }
}

/// All that a picture takes once the markers are known.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_picture(camera: &mut Camera, frame: &Frame, learn: bool, taken_ms: u32) -> Summary {
    camera.picture(frame, learn, taken_ms, taken_ms)
}

/// Numbers are written so that they read back as the same bits.
fn answer(summary: &Summary) {
    let mut said = String::<SAID_MAX>::new();
    // What does not fit is missed by the host.
    let _ = write!(said, "{summary:?}");
    let bytes = said.bytes().chain(core::iter::repeat(0));
    TENAX_KERNELS_SAID.iter().zip(bytes).for_each(|(to, byte)| to.store(byte, Relaxed));
}
