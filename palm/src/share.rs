//! Shares the grip: the least forces that keep each finger's margin, stay below each ceiling and balance the load.
//!
//! A linear programme with a variable for each finger and one or two equations, those of balance in the plane of the grip. Its optimum is a
//! corner: as many fingers as there are equations are free, the others stand at a bound. There are at most 80 corners for five fingers, and
//! all of them are tried in whole numbers, so the result is exact to the rounding of 1 mN a finger.

use heapless::Vec;

use crate::bus::FINGERS_MAX;

/// A finger that touches the object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Contact {
    /// Where its force points, per mille of it, in the plane of the grip.
    pub normal: [i16; 2],
    /// The least force that keeps its margin, mN.
    pub least_mn: i32,
    /// Its ceiling, mN.
    pub most_mn: i32,
}

/// A force for each contact, in their order, mN.
pub type Forces = Vec<i32, FINGERS_MAX>;

/// Forces are clamped to this, so that no product is above 2^63: 131 N.
const FORCE_MAX_MN: i32 = 1 << 17;

const fn cross(a: [i64; 2], b: [i64; 2]) -> i64 {
    a[0] * b[1] - a[1] * b[0]
}

const fn dot(a: [i64; 2], b: [i64; 2]) -> i64 {
    a[0] * b[0] + a[1] * b[1]
}

/// What the forces that are felt add up to, in mN times per mille: what the object is pushed with in the plane of the grip.
#[must_use]
pub fn load(contacts: &[Contact], felt_mn: &[i32]) -> [i64; 2] {
    contacts.iter().zip(felt_mn).fold([0; 2], |sum, (contact, &mn)| {
        let [x, y] = contact.normal.map(|part| i64::from(part) * i64::from(mn.clamp(0, FORCE_MAX_MN)));
        [sum[0] + x, sum[1] + y]
    })
}

/// The least sum of forces whose push on the object is `load`. None if no forces within the bounds balance it.
#[must_use]
pub fn share(contacts: &[Contact], load: [i64; 2]) -> Option<Forces> {
    let bounds: Vec<([i64; 2], i64, i64), FINGERS_MAX> = contacts
        .iter()
        .take(FINGERS_MAX)
        .map(|contact| {
            let [least, most] =
                [contact.least_mn, contact.most_mn].map(|mn| i64::from(mn.clamp(0, FORCE_MAX_MN)));
            (contact.normal.map(i64::from), least, most)
        })
        .collect();
    if bounds.iter().any(|(_, least, most)| least > most) {
        return None;
    }
    let flat = bounds.iter().all(|a| bounds.iter().all(|b| cross(a.0, b.0) == 0));
    let mut best: Option<(i64, Forces)> = None;
    for one in 0..bounds.len() {
        for two in one..bounds.len() {
            // Fingers in one line leave one equation, and so one free finger.
            if flat != (one == two) {
                continue;
            }
            for corner in 0..1u8 << bounds.len() {
                // The bits of the free ones choose nothing: they have their lower bounds at least.
                if corner & (1 << one | 1 << two) == 0
                    && best.as_ref().is_none_or(|(least, _)| floor(&bounds, corner) < *least)
                    && let Some(forces) = at_corner(&bounds, load, [one, two], corner)
                {
                    let sum = forces.iter().map(|&mn| i64::from(mn)).sum();
                    if best.as_ref().is_none_or(|(least, _)| sum < *least) {
                        best = Some((sum, forces));
                    }
                }
            }
        }
    }
    best.map(|(_, forces)| forces)
}

/// The sum of forces below which no force of a corner is.
fn floor(bounds: &[([i64; 2], i64, i64)], corner: u8) -> i64 {
    bounds
        .iter()
        .enumerate()
        .map(|(n, &(_, least, most))| if corner >> n & 1 == 1 { most } else { least })
        .sum()
}

/// The forces of one corner: fingers other than `free` at their upper bound where `corner` has their bit, else at the lower.
fn at_corner(
    bounds: &[([i64; 2], i64, i64)],
    load: [i64; 2],
    [one, two]: [usize; 2],
    corner: u8,
) -> Option<Forces> {
    let mut forces = Forces::new();
    let mut rest = load;
    for (n, &(normal, least, most)) in bounds.iter().enumerate() {
        let mn = if corner >> n & 1 == 1 { most } else { least };
        if n != one && n != two {
            rest = [rest[0] - normal[0] * mn, rest[1] - normal[1] * mn];
        }
        forces.push(mn as i32).ok()?;
    }
    let (a, b) = (bounds.get(one)?, bounds.get(two)?);
    if one == two {
        *forces.get_mut(one)? = rounded(dot(rest, a.0), dot(a.0, a.0), (a.1, a.2))?;
    } else {
        let whole = cross(a.0, b.0);
        *forces.get_mut(one)? = rounded(cross(rest, b.0), whole, (a.1, a.2))?;
        *forces.get_mut(two)? = rounded(cross(a.0, rest), whole, (b.1, b.2))?;
    }
    Some(forces)
}

/// The quotient to the nearest, None where it is outside the bounds by more than half a millinewton.
fn rounded(part: i64, whole: i64, (least, most): (i64, i64)) -> Option<i32> {
    let (part, whole) = if whole < 0 { (-part, -whole) } else { (part, whole) };
    if whole == 0 {
        return None;
    }
    let part = part + whole / 2;
    // Most are outside, and a product says so sooner than a quotient.
    (least * whole..(most + 1) * whole).contains(&part).then(|| part.div_euclid(whole) as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(normal: [i16; 2], least_mn: i32) -> Contact {
        Contact { normal, least_mn, most_mn: 40_000 }
    }

    #[test]
    fn a_pair_presses_as_hard_as_the_one_that_needs_more() {
        let pair = [contact([1_000, 0], 2_000), contact([-1_000, 0], 5_000)];
        assert_eq!(share(&pair, [0; 2]).unwrap().as_slice(), [5_000, 5_000]);
        // The object leans on the second with 3 N: that is met without any force of its own.
        assert_eq!(share(&pair, [-3_000_000, 0]).unwrap().as_slice(), [2_000, 5_000]);
    }

    #[test]
    fn a_thumb_bears_what_four_fingers_need_together() {
        let fingers = [1_000, 2_000, 3_000, 4_000].map(|mn| contact([-1_000, 0], mn));
        let hand = [&[contact([1_000, 0], 500)], fingers.as_slice()].concat();
        assert_eq!(share(&hand, [0; 2]).unwrap().as_slice(), [10_000, 1_000, 2_000, 3_000, 4_000]);
    }

    #[test]
    fn three_around_a_ball_press_alike() {
        let ball = [contact([1_000, 0], 1_000), contact([-500, 866], 3_000), contact([-500, -866], 1_000)];
        assert_eq!(share(&ball, [0; 2]).unwrap().as_slice(), [3_000, 3_000, 3_000]);
    }

    #[test]
    fn where_a_ceiling_stands_in_the_way_there_is_no_share() {
        let pair = [contact([1_000, 0], 2_000), Contact { most_mn: 1_900, ..contact([-1_000, 0], 0) }];
        assert_eq!(share(&pair, [0; 2]), None);
        assert_eq!(share(&[Contact { most_mn: 1, ..contact([1_000, 0], 2) }], [1_000, 0]), None);
        assert_eq!(share(&[], [0; 2]), None);
    }
}
