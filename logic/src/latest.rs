/// Newest first; the oldest is dropped. `rotate_right` would link a memmove of 1.6 kB.
pub fn push<T: Copy, const N: usize>(latest: &mut [T; N], newest: T) {
    let mut carried = newest;
    for slot in latest {
        carried = core::mem::replace(slot, carried);
    }
}
