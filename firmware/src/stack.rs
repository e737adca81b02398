//! A guard under the stack: what overflows it is a fault, and does not eat the black box, which lies below.

use core::ptr::addr_of;

use cortex_m::asm::{dsb, isb};
use cortex_m::peripheral::MPU;

unsafe extern "C" {
    /// The end of what is not initialised (cortex-m-rt's `link.x`): from here on there is only stack.
    static __euninit: u32;
}

/// More than most functions take at once, 2 KiB; a region begins at a multiple of its size.
const SIZE: u32 = 1 << SIZE_BITS;
const SIZE_BITS: u32 = 11;
/// RASR (ARM DDI 0403E, section B3.5.9): nothing may be executed, read or written, of this size, enabled.
const NO_ACCESS: u32 = 1 << 28 | (SIZE_BITS - 1) << 1 | 1;
/// CTRL (section B3.5.5): everything else as without it; not in the handler of a fault, which needs a stack.
const ENABLED: u32 = 1 << 2 | 1;

/// Switches the guard on. A fault of it is a hard one: `last_words`.
pub fn guard() {
    let base = (addr_of!(__euninit) as u32 + SIZE - 1) & !(SIZE - 1);
    // SAFETY: nobody uses these bytes but a stack that overflows, and nobody else sets a region.
    unsafe {
        let mpu = &*MPU::PTR;
        mpu.rnr.write(0);
        mpu.rbar.write(base);
        mpu.rasr.write(NO_ACCESS);
        mpu.ctrl.write(ENABLED);
    }
    dsb();
    isb();
}
