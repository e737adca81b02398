//! Short histories as arrays, the newest value first.

/// Newest first; the oldest is dropped. `rotate_right` would link a memmove of 1.6 kB.
pub fn push<T: Copy, const N: usize>(latest: &mut [T; N], newest: T) {
    let mut carried = newest;
    for slot in latest {
        carried = core::mem::replace(slot, carried);
    }
}

#[cfg(test)]
mod tests {
    use super::push;

    #[test]
    fn the_newest_is_first_and_the_oldest_is_gone() {
        let mut latest = [3, 2, 1];
        push(&mut latest, 4);
        assert_eq!(latest, [4, 3, 2]);
    }
}
