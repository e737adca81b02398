//! Two myoelectric sensors on the forearm: rectified, smoothed envelopes.

use std::f64::consts::TAU;

use tenax_hal_shim::channel::{MYO_EXTENSOR, MYO_FLEXOR};
use tenax_hal_shim::front_end::MYO_REST_MV;

use super::front_end_v;
use crate::file::sections::{ElectrodeLift, Myo};
use crate::physics::wearer::Effort;
use crate::random::{Noise, Source};
use crate::schedule::LowPass;
use crate::schedule::Span;

pub(crate) const SIDES: usize = 2;
/// A one-pole takes 2.2 time constants from 10 to 90 %.
const RISE_TAUS: f64 = 2.197;
/// The envelope of an irregular signal wanders about this fast, Hz (assumed).
const WANDER_HZ: f64 = 6.0;
/// The part of a lifted electrode's mains that is ripple; the rest is level.
const RIPPLE_PART: f64 = 0.2;
/// An electrode that a person lifts at the bench (assumed).
const LIFTED_S: f64 = 3.0;
const LIFTED_MV: f64 = 400.0;

#[derive(Debug)]
pub(crate) struct Envelopes {
    parameters: Myo,
    mains_hz: f64,
    lifts: Vec<(usize, Span, f64)>,
    sides: [Side; SIDES],
    noise: Noise,
}

#[derive(Clone, Copy, Debug)]
struct Side {
    envelope: LowPass,
    wander: LowPass,
}

impl Envelopes {
    pub(crate) fn new(parameters: &Myo, lifts: &[ElectrodeLift], mains_hz: f64, seed: u64) -> Self {
        let side = Side {
            envelope: LowPass::of_frames(parameters.rise_ms.get() / 1e3 / RISE_TAUS),
            wander: LowPass::of_frames(1.0 / (TAU * WANDER_HZ)),
        };
        let lifts = lifts.iter().map(|lift| {
            let side = lift.channel.get_ref().index() - MYO_FLEXOR;
            (side, Span::of(lift.at_s, lift.for_s), lift.pickup_mv.get())
        });
        Self {
            parameters: parameters.clone(),
            mains_hz,
            lifts: lifts.collect(),
            sides: [side; SIDES],
            noise: Noise::new(seed, Source::Myo),
        }
    }

    pub(crate) fn lift(&mut self, side: usize, at_s: f64) {
        self.lifts.push((side, Span::new(at_s, LIFTED_S), LIFTED_MV));
    }

    pub(crate) fn step(&mut self, t_s: f64, effort: &Effort) -> [f64; SIDES] {
        const { assert!(MYO_EXTENSOR == MYO_FLEXOR + 1) };
        let p = &self.parameters;
        // Rectified mains has twice the frequency.
        let ripple = libm::sin(TAU * 2.0 * self.mains_hz * t_s);
        let own_mv = [effort.flexor_mv, effort.extensor_mv];
        let mut pins = [0.0; SIDES];
        for (n, side) in self.sides.iter_mut().enumerate() {
            let wander = side.wander.step(self.noise.normal()) / side.wander.noise_gain();
            let lift = self.lifts.iter().find(|(lifted, span, _)| *lifted == n && span.contains(t_s));
            let heard_mv = match lift {
                Some((_, _, pickup_mv)) => pickup_mv * (1.0 + RIPPLE_PART * ripple),
                None => {
                    let muscle_mv = own_mv[n] + p.crosstalk.get() * own_mv[1 - n];
                    p.tone_mv.get() + muscle_mv + both(p.noise_mv.get(), p.ripple.get() * muscle_mv) * wander
                }
            };
            let envelope_mv = side.envelope.step(heard_mv) + p.mains_mv.get() * ripple;
            pins[n] = front_end_v(f64::from(MYO_REST_MV) + envelope_mv.max(0.0));
        }
        pins
    }
}

fn both(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schedule::FRAME_S;

    #[test]
    fn an_envelope_rises_in_60_ms_and_the_other_side_stays_below_its_threshold() {
        let quiet =
            Myo { mains_mv: crate::file::quantity::Millivolts::of(0.0), ..crate::file::plain("", "").myo };
        let mut envelopes = Envelopes::new(&quiet, &[], 50.0, 1);
        let effort = Effort { flexor_mv: 1_000.0, ..Effort::default() };
        let (mut ten_s, mut ninety_s) = (None, None);
        (0..2_000).for_each(|n| _ = envelopes.step(f64::from(n) * FRAME_S, &Effort::default()));
        for n in 0..2_000 {
            let t_s = f64::from(n) * FRAME_S;
            let [flexor, extensor] = envelopes.step(1.0 + t_s, &effort).map(|volts| volts * 1e3 - 300.0);
            if flexor > 150.0 {
                ten_s.get_or_insert(t_s);
            }
            if flexor > 950.0 {
                ninety_s.get_or_insert(t_s);
            }
            assert!(extensor < 160.0, "crosstalk of {extensor} mV");
        }
        let rise_s = ninety_s.unwrap() - ten_s.unwrap();
        assert!((0.040..0.090).contains(&rise_s), "{rise_s} s");
    }
}
