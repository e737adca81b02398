//! Where the core stands while the host uses its memory, and what it does after a panic: of every image that the host drives.

use core::panic::PanicInfo;

/// Where the core stands while the host reads the last answer and writes what comes next.
#[inline(never)]
#[unsafe(no_mangle)]
pub extern "C" fn tenax_kernels_next() {
    cortex_m::asm::nop();
}

#[panic_handler]
fn on_panic(_: &PanicInfo) -> ! {
    // The host notices that nobody comes for what is next.
    loop {
        cortex_m::asm::nop();
    }
}
