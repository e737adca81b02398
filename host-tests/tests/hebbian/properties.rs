//! What holds for any input.

use proptest::array::uniform24;
use proptest::prelude::*;
use tenax_logic::hebbian::{
    Activation, Activations, Code, Codes, Config, FingertipNetwork, Normaliser, NormaliserConfig, RECEPTORS,
    Rule, Sense,
};

use super::oracle::{outputs, weights_of};

fn code() -> impl Strategy<Value = Code> {
    (-1..=1).prop_map(Code::from_sign)
}

fn configs() -> impl Strategy<Value = Config> {
    (Config::ALPHA_PPB, Config::BETA_PPB, Config::DELTA_PPM)
        .prop_map(|(alpha_ppb, beta_ppb, delta_ppm)| Config { alpha_ppb, beta_ppb, delta_ppm })
}

fn lessons() -> impl Strategy<Value = Vec<([f64; RECEPTORS], Codes)>> {
    prop::collection::vec((uniform24(-1.5..1.5f64), [code(), code()]), 1..200)
}

fn felt(t: &[f64; RECEPTORS]) -> Activations<RECEPTORS> {
    Activations::new(t.map(Activation::from_f64))
}

fn taught(config: &Config, lessons: &[([f64; RECEPTORS], Codes)]) -> FingertipNetwork {
    let rule = Rule::of(config);
    let mut network = FingertipNetwork::default();
    for (t, codes) in lessons {
        network.learn(&rule, &felt(t), &codes.map(Some));
    }
    network
}

const NORMALISER: NormaliserConfig<RECEPTORS> = NormaliserConfig {
    senses: [Sense::Pressure; RECEPTORS],
    floors: [1; RECEPTORS],
    ceiling: i32::MAX as u32,
    average_shift: 0,
};

proptest! {
    #[test]
    fn weights_are_bounded(config in configs(), lessons in lessons()) {
        let network = taught(&config, &lessons);
        // |w| never exceeds alpha / beta, nor the limit.
        let bound = f64::from(config.alpha_ppb) / f64::from(config.beta_ppb.max(1));
        for w in weights_of(&network).iter().flatten() {
            prop_assert!(w.abs() <= bound.min(8.0) * (1.0 + 1e-6) + 1e-7, "{w} {bound}");
        }
    }

    /// Cables that were exchanged before learning do not matter, to the last bit.
    #[test]
    fn receptors_can_be_permuted(
        config in configs(), lessons in lessons(),
        order in Just((0..RECEPTORS).collect::<Vec<_>>()).prop_shuffle(),
    ) {
        let permuted = |t: &[f64; RECEPTORS]| std::array::from_fn(|j| t[order[j]]);
        let straight = taught(&config, &lessons);
        let swapped: Vec<_> = lessons.iter().map(|(t, codes)| (permuted(t), *codes)).collect();
        let swapped = taught(&config, &swapped);
        for output in 0..2 {
            for (j, &from) in order.iter().enumerate() {
                prop_assert_eq!(swapped.weights()[output][j], straight.weights()[output][from]);
            }
        }
        let (t, _) = &lessons[0];
        prop_assert_eq!(outputs(&straight, &felt(t)), outputs(&swapped, &felt(&permuted(t))));
    }

    #[test]
    fn no_reading_can_break_the_normaliser(
        readings in prop::collection::vec(uniform24(any::<i32>()), 1..20),
        floor in any::<u32>(), ceiling in any::<u32>(), average_shift in any::<u32>(),
    ) {
        let config = NormaliserConfig { floors: [floor; RECEPTORS], ceiling, average_shift, ..NORMALISER };
        let mut normaliser = Normaliser::new(&config);
        let mut activations = Activations::default();
        for raw in readings {
            normaliser.observe(&config, &raw);
            prop_assert!(normaliser.maxima().iter().all(|&m| m >= 1 && m <= ceiling.max(1)));
            normaliser.renew(&config, 0, &raw, &mut activations);
            prop_assert!(activations.as_bits().iter().all(|t| t.abs() <= 1 << 26));
        }
    }
}
