//! Acts of a person at the bench during a scene: grips, pulls, wets, touches a sensor.

use std::f64::consts::TAU;
use std::str::FromStr;

use tenax_hal_shim::channel::{
    ARRAY, ARRAY_COUNT, COUNT, FSR, FSR_COUNT, OPENING, PVDF, PVDF_COUNT, Role, STRAIN, STRAIN_COUNT, by_name,
};

use crate::schedule::{Span, smooth};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Act {
    Grip,
    PutDown,
    Pull,
    Wet,
    /// 100 g more.
    Load,
    /// The next film loses its wire.
    CutFilm,
    /// The flexor's electrode leaves the skin for 3 s.
    LiftElectrode,
    Close,
    Open,
    Weight(f64),
    Touch(usize),
}

pub const KEYS: [(&str, &str, Act); 9] = [
    ("g", "grip and lift", Act::Grip),
    ("d", "put down", Act::PutDown),
    ("p", "pull", Act::Pull),
    ("w", "wet or dry", Act::Wet),
    ("h", "make it heavier", Act::Load),
    ("f", "cut a film", Act::CutFilm),
    ("e", "lift an electrode", Act::LiftElectrode),
    ("c", "contract to close", Act::Close),
    ("o", "contract to open", Act::Open),
];

impl FromStr for Act {
    type Err = ();

    fn from_str(line: &str) -> Result<Self, ()> {
        let mut words = line.split_whitespace();
        let (first, second) = (words.next().ok_or(())?, words.next());
        if let Some((_, _, act)) = KEYS.iter().find(|(key, ..)| *key == first && second.is_none()) {
            return Ok(*act);
        }
        let second = second.ok_or(())?.trim_end_matches([',', ':']);
        if first == "weight" {
            let newtons = second.parse().ok().filter(|n| (0.1..=60.0).contains(n));
            return newtons.map(Self::Weight).ok_or(());
        }
        // In the place of a film there may be a head, which is pressed.
        let asks =
            |channel: &usize| [false, true].iter().any(|&head| Role::of(*channel, head).verb() == first);
        by_name(second).filter(asks).map(Self::Touch).ok_or(())
    }
}

/// Reaction time of a person who is told to do something, s (all here assumed).
pub(crate) const REACTS_S: f64 = 0.2;
const TOUCHES_S: f64 = 0.5;
const RAMP_S: f64 = 0.05;
/// A finger that touches one sensor moves its neighbours by this part.
const NEIGHBOURS: f64 = 0.1;
const TAP_V: f64 = 0.6;
const TAP_HZ: f64 = 180.0;
const TAP_S: f64 = 0.015;
const TAPS_EACH_S: f64 = 0.137;
const BENT_V: f64 = 0.25;
const TAXEL_V: f64 = 0.4;
const TURNED_V: f64 = 0.5;
const QUADRANT_N: f64 = 3.0;

#[derive(Clone, Debug, Default)]
pub(crate) struct Touches {
    touched: Vec<(Span, usize)>,
    weights: Vec<(Span, f64)>,
}

impl Touches {
    pub(crate) fn touch(&mut self, at_s: f64, channel: usize) {
        self.touched.push((Span::new(at_s, TOUCHES_S), channel));
    }

    pub(crate) fn weigh(&mut self, at_s: f64, newtons: f64) {
        self.weights.push((Span::new(at_s, 2.5), newtons));
    }

    fn drop_past(&mut self, t_s: f64) {
        self.touched.retain(|(span, _)| t_s < span.end_s);
        self.weights.retain(|(span, _)| t_s < span.end_s);
    }

    pub(crate) fn pressed_n(&mut self, t_s: f64) -> [f64; FSR_COUNT] {
        self.drop_past(t_s);
        let weight_n: f64 = self.weights.iter().map(|(span, n)| n * part(*span, t_s)).sum();
        let mut pressed_n = [weight_n / FSR_COUNT as f64; FSR_COUNT];
        for (span, channel) in &self.touched {
            share(&mut pressed_n, *channel, FSR, QUADRANT_N * part(*span, t_s));
        }
        pressed_n
    }

    pub(crate) fn apply(&self, t_s: f64, pins_v: &mut [f64; COUNT]) {
        for &(span, channel) in &self.touched {
            let pushed = part(span, t_s);
            share(&mut pins_v[PVDF..PVDF + PVDF_COUNT], channel, PVDF, TAP_V * rings(t_s - span.begin_s));
            share(&mut pins_v[STRAIN..STRAIN + STRAIN_COUNT], channel, STRAIN, BENT_V * pushed);
            share(&mut pins_v[ARRAY..ARRAY + ARRAY_COUNT], channel, ARRAY, TAXEL_V * pushed);
            if channel == OPENING {
                // To where there is room.
                pins_v[OPENING] += if pins_v[OPENING] > 1.5 { -TURNED_V } else { TURNED_V } * pushed;
            }
        }
    }
}

fn share(kind: &mut [f64], channel: usize, first: usize, adds: f64) {
    let Some(touched) = channel.checked_sub(first).filter(|n| *n < kind.len()) else { return };
    for (n, value) in kind.iter_mut().enumerate() {
        *value += if n == touched { adds } else { NEIGHBOURS * adds };
    }
}

fn part(span: Span, t_s: f64) -> f64 {
    smooth(((t_s - span.begin_s) / RAMP_S).clamp(0.0, 1.0))
        * smooth(((span.end_s - t_s) / RAMP_S).clamp(0.0, 1.0))
}

fn rings(since_s: f64) -> f64 {
    if since_s < 0.0 {
        return 0.0;
    }
    let tap_s = since_s % TAPS_EACH_S;
    libm::exp(-tap_s / TAP_S) * libm::sin(TAU * TAP_HZ * tap_s)
}
