//! Offset of the contact from the pad's middle. A load beside the middle, or quadrants of unequal gains, read
//! as a shear that is a part of the load. While the hand closes on an object that does not slide, shear grows
//! by that part alone, so the part is fitted there and subtracted.

use tenax_hal_shim::channel::FSR_COUNT;

/// Readings between the two of a difference: 50 ms, as long as a pulse.
const SPAN: usize = 4;
/// Least growth of the load in this time that shows the part, mN: several times the noise, and faster than an object
/// that is lifted meanwhile adds shear.
const LEAST_MN: i32 = 150;
/// Weight of "the contact is in the middle", in (16 mN)^2: a difference of 0.36 N.
const PRIOR: i32 = 500;
/// Sums are halved from here on, so that newer differences count more.
const SUM_MAX: i32 = 1 << 20;
/// Fraction bits of the part.
const Q: u32 = 10;
/// Largest part: 3 mm beside the middle of a pad of 18 mm, with gains that differ by 20 %.
const MOST: i32 = 820;

#[derive(Clone, Copy, Debug, Default)]
pub struct Contact {
    /// Load, Fx and Fy of the last readings, mN, the newest first.
    before: [[i32; 3]; SPAN],
    /// Sums of dL^2, dFx dL and dFy dL, (16 mN)^2.
    sums: [i32; 3],
    /// Fx and Fy as a part of the load, [`Q`] fraction bits.
    part: [i32; 2],
}

impl Contact {
    /// Quadrants A to D without drift, mN, once a slow frame. `closes`: the hand has closed over the last
    /// readings, and nothing slides.
    pub fn feel(&mut self, [a, b, c, d]: [i32; FSR_COUNT], loaded_mn: i32, closes: bool) {
        let now = [a + b + c + d, (a + b) - (c + d), (a + d) - (c + b)];
        let [.., oldest] = self.before;
        crate::latest::push(&mut self.before, now);
        if now[0] < loaded_mn / 4 {
            (self.sums, self.part) = ([0; 3], [0; 2]);
            return;
        }
        let grown = now[0] - oldest[0];
        if !closes || grown < LEAST_MN {
            return;
        }
        for (sum, n) in self.sums.iter_mut().zip(0..) {
            // Forces are below 2^17 mN, so that a product is below 2^26.
            *sum += (grown >> 4) * ((now[n] - oldest[n]) >> 4);
        }
        if self.sums[0] > SUM_MAX {
            self.sums = self.sums.map(|sum| sum / 2);
        }
        let [squares, x, y] = self.sums.map(i64::from);
        let part = |sum: i64| (sum << Q).checked_div(squares + i64::from(PRIOR)).unwrap_or(0) as i32;
        self.part = [part(x), part(y)].map(|part| part.clamp(-MOST, MOST));
    }

    /// Quadrants as a contact in the middle would load them, mN.
    pub fn centred(&self, cells: [i32; FSR_COUNT]) -> [i32; FSR_COUNT] {
        if self.part == [0; 2] {
            return cells;
        }
        let load_mn: i32 = cells.iter().sum();
        let [x, y] = self.part.map(|part| ((load_mn.min(1 << 17) >> 2) * part) >> Q);
        let [a, b, c, d] = cells;
        [a - x - y, b - x + y, c + x + y, d + x - y].map(|mn| mn.max(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quadrants of a load with its centre and its shear along x, mN.
    fn cells(load_mn: i32, x_permille: i32, shear_mn: i32) -> [i32; FSR_COUNT] {
        let x_mn = load_mn * x_permille / 1_000 + shear_mn;
        let [more, less] = [load_mn + x_mn, load_mn - x_mn].map(|mn| mn / 4);
        [more, more, less, less]
    }

    fn shear_mn([a, b, c, d]: [i32; FSR_COUNT]) -> i32 {
        (a + b) - (c + d)
    }

    #[test]
    fn an_offset_that_shows_at_the_touch_is_no_shear_and_a_shear_stays_one() {
        for x_permille in [-600, -350, 0, 350, 600] {
            let mut contact = Contact::default();
            for load_mn in [0, 300, 900, 1_800, 3_000, 4_000, 4_000, 4_000] {
                contact.feel(cells(load_mn, x_permille, 0), 600, load_mn < 4_000);
            }
            let rests = shear_mn(contact.centred(cells(4_000, x_permille, 0)));
            assert!(rests.abs() < 100, "{x_permille}: {rests} mN");
            let loaded = shear_mn(contact.centred(cells(4_000, x_permille, 800)));
            assert!((700..=900).contains(&loaded), "{x_permille}: {loaded} mN");
        }
    }

    #[test]
    fn what_is_lifted_slowly_while_the_hand_closes_and_what_closes_in_noise_is_no_offset() {
        let (mut lifted, mut heard) = (Contact::default(), Contact::default());
        for n in 0..100 {
            lifted.feel(cells(20 * n, 0, 6 * n), 600, true);
            heard.feel(cells(100 * n, 300, 0), 600, false);
        }
        assert_eq!(shear_mn(lifted.centred(cells(2_000, 0, 600))), 600);
        assert_eq!(shear_mn(heard.centred(cells(2_000, 300, 0))), 600);
    }

    #[test]
    fn the_offset_of_a_grasp_ends_with_it() {
        let mut contact = Contact::default();
        (0..10).for_each(|n| contact.feel(cells(400 * n, 400, 0), 600, true));
        assert!(shear_mn(contact.centred(cells(2_000, 400, 0))) < 200);
        contact.feel(cells(0, 0, 0), 600, false);
        assert_eq!(contact.centred(cells(2_000, 400, 0)), cells(2_000, 400, 0));
    }
}
