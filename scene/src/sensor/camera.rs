//! A camera that watches a mark on the hand and one on the object, and says three words about it (Tada 2006, eqs 1, 2).

use std::collections::VecDeque;

use tenax_hal_shim::wire::Down;
use tenax_hal_shim::words::Code;

use crate::file::sections::Camera;
use crate::random::{Noise, Source};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    pub t_s: f64,
    pub arrives_s: f64,
    /// -1: the object moves against the hand, 1: they move as one, 0: neither moves.
    pub v1: i8,
    /// 1: the hand moves up, -1: down, 0: not.
    pub v2: i8,
}

/// Marks on whole pixels, two images.
///
/// One pixel is 1.32 mm, so what moves slowly crosses a pixel in some images and not in others: the words chatter, as in
/// Tada 2006, figure 6 (a) and (b), and a slip is seen two images late.
#[derive(Debug)]
pub(crate) struct Eye {
    parameters: Camera,
    /// Places of the marks on the grid of pixels, parts of a pixel.
    phases: [f64; 2],
    noise: Noise,
    images: u64,
    last_px: Option<[i64; 2]>,
    under_way: VecDeque<Seen>,
    arrived: Option<Seen>,
    unsent: Option<Seen>,
}

impl Eye {
    pub(crate) fn new(parameters: &Camera, seed: u64) -> Self {
        let mut noise = Noise::new(seed, Source::Camera);
        Self {
            parameters: parameters.clone(),
            phases: [noise.between(0.0, 1.0), noise.between(0.0, 1.0)],
            noise,
            images: 0,
            last_px: None,
            under_way: VecDeque::new(),
            arrived: None,
            unsent: None,
        }
    }

    pub(crate) fn step(&mut self, t_s: f64, hand_mm: f64, object_mm: f64) -> Option<Seen> {
        while self.under_way.front().is_some_and(|seen| seen.arrives_s <= t_s) {
            self.arrived = self.under_way.pop_front();
            self.unsent = self.arrived;
        }
        let p = &self.parameters;
        if t_s * p.rate_hz.get() < self.images as f64 {
            return None;
        }
        self.images += 1;
        let places = [hand_mm, object_mm - hand_mm];
        let px: [i64; 2] = std::array::from_fn(|n| {
            let jitter = p.jitter_px.get() * self.noise.normal();
            (places[n] / p.pixel_mm.get() + self.phases[n] + jitter).floor() as i64
        });
        let last = self.last_px.replace(px)?;
        let hand = px[0].cmp(&last[0]) as i8;
        let relative = px[1] != last[1];
        let arrives_s = t_s + p.delay_ms.get() / 1e3;
        let seen = Seen { t_s, arrives_s, v1: if relative { -1 } else { hand.abs() }, v2: hand };
        self.under_way.push_back(seen);
        Some(seen)
    }

    pub(crate) const fn said(&self) -> Option<Seen> {
        self.arrived
    }

    pub(crate) fn teach(&mut self, t_s: f64) -> Option<Down> {
        let seen = self.unsent.take().filter(|_| self.parameters.teaches)?;
        let age_ms = ((t_s - seen.t_s) * 1e3).round() as u16;
        Some(Down::Teach { codes: [seen.v1, seen.v2].map(|v| Code::from_sign(v.into())), age_ms })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(hand_mm_s: f64, object_mm_s: f64) -> Vec<Seen> {
        let mut eye = Eye::new(
            &Camera { jitter_px: crate::file::quantity::Part::of(0.0), ..crate::file::plain("", "").camera },
            1,
        );
        (0..8_000)
            .filter_map(|n| {
                let t_s = f64::from(n) / 8e3;
                eye.step(t_s, hand_mm_s * t_s, object_mm_s * t_s)
            })
            .collect()
    }

    #[test]
    fn still_as_one_apart_and_slow_are_told_by_29_words_a_second() {
        // 50 mm/s is more than a pixel an image.
        for (hand_mm_s, object_mm_s, said) in
            [(0.0, 0.0, (0, 0)), (50.0, 50.0, (1, 1)), (-50.0, -50.0, (1, -1)), (50.0, 0.0, (-1, 1))]
        {
            let words = words(hand_mm_s, object_mm_s);
            assert_eq!(words.len(), 29);
            assert!(words.iter().all(|seen| (seen.v1, seen.v2) == said), "{said:?}");
        }
        // Tada's 25 mm/s are 0.63 of a pixel an image: some 18 of 29 images see it, and no two in a row do without.
        let words = words(25.0, 25.0);
        let seen = words.iter().filter(|seen| seen.v2 == 1).count();
        assert!((17..=19).contains(&seen), "{seen}");
        assert!(words.windows(2).all(|pair| pair[0].v2 == 1 || pair[1].v2 == 1));
    }
}
