//! Whether an object goes on beyond the picture's border, where nobody knows how.
//!
//! It does if it reaches the border. While its colours are still being learned it does also if only what differs from the scene
//! leads on from it to the border: its end has colours that are not known yet.

use crate::mask::Mask;

const REACH_PX: usize = 24;

pub fn is_cut(object: &Mask, unknown: Option<&Mask>) -> bool {
    if object.comes_within(1) {
        return true;
    }
    let Some(unknown) = unknown.filter(|_| object.comes_within(REACH_PX)) else { return false };
    let mut grown = object.clone();
    for _ in 0..REACH_PX {
        grown.dilate(1);
        grown.intersect(unknown);
        if grown.comes_within(1) {
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(columns: std::ops::Range<usize>, rows: std::ops::Range<usize>) -> Mask {
        let mut mask = Mask::EMPTY;
        rows.for_each(|y| columns.clone().for_each(|x| mask.insert(x, y)));
        mask
    }

    #[test]
    fn what_leads_on_to_the_border_is_cut_and_what_a_hand_holds_is_not() {
        let object = block(15..100, 100..140);
        assert!(!is_cut(&object, None) && !is_cut(&object, Some(&object)));
        assert!(is_cut(&object, Some(&block(0..100, 100..140))), "its end has other colours");
        assert!(is_cut(&block(0..100, 100..140), None));
        assert!(!is_cut(&block(40..100, 100..140), Some(&block(0..100, 100..140))), "a hand holds it");
    }
}
