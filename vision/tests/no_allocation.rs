//! Nothing is allocated from a camera's first picture on: counted by the allocator of this test's own binary.

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use tenax_vision::Camera;
use tenax_vision::frame::{Frame, WIDTH};
use tenax_vision::object::Config;
use tenax_vision::rectify::Rectifier;

use common::{Noise, draw_discs, plane};

thread_local! {
    static ASKED: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, and how often this thread asked it for memory.
struct Counting;

fn asked() {
    // A thread that ends has no counter any more, and is not this test's.
    let _ = ASKED.try_with(|count| count.set(count.get() + 1));
}

// SAFETY: every call goes to the system's allocator unchanged; counting allocates nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        asked();
        // SAFETY: the caller's promises are the system's.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        asked();
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        asked();
        // SAFETY: as above.
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// How often something asks for memory.
fn allocations(of: impl FnOnce()) -> usize {
    let before = ASKED.get();
    of();
    ASKED.get() - before
}

#[test]
fn no_picture_allocates_from_calibration_to_slip() {
    assert!(allocations(|| drop(plane(3))) > 0, "the control");
    let mut camera = Camera::new(Config::default());
    camera.rectify(Rectifier::new(250.0));
    let discs: Vec<_> =
        (0..20).map(|at| (50.0 + 50.0 * (at % 5) as f32, 40.0 + 50.0 * (at / 5) as f32, 4.5)).collect();
    let (mut noise, mut grey) = (Noise(5), plane(0));
    let (mut red, mut green) = (plane(0), plane(0));
    let (mut seen, mut slips, mut most) = (0, 0, 0);
    for number in 0..90 {
        draw_discs(&discs, |x, y| 150.0 + 20.0 * ((x + y) / 30.0).sin(), 2.0, &mut noise, &mut grey);
        red.copy_from_slice(&grey[..]);
        green.copy_from_slice(&grey[..]);
        // A green bar comes from the right, is held, and slides on.
        let left = match number {
            0..20 => WIDTH,
            20..50 => WIDTH - 7 * (number - 19),
            50..70 => WIDTH - 210,
            _ => WIDTH - 210 - 2 * (number - 70),
        };
        for y in 100..140 {
            for x in left..(left + 120).min(WIDTH) {
                let at = y * WIDTH + x;
                let stripe = if (x - left) / 6 % 2 == 0 { 40 } else { 0 };
                if grey[at] > 70 {
                    (red[at], green[at]) = (60 + stripe, 180 + stripe);
                }
            }
        }
        let frame = Frame { red: &red, green: &green, blue: &grey };
        let mut summary = None;
        let count = allocations(|| {
            summary = Some(camera.picture(&frame, number < 50, 33 * number as u32, 33 * number as u32))
        });
        most = most.max(count);
        let summary = summary.expect("a picture");
        seen += usize::from(summary.object.is_some());
        slips += usize::from(summary.slips());
    }
    assert!(camera.markers().is_some_and(|markers| markers.len() >= 15));
    assert!(seen > 40 && slips > 10, "all of the way was gone: {seen} {slips}");
    assert_eq!(most, 0, "allocations in one picture");
}
