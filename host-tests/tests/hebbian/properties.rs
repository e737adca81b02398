//! What holds for any input.

use proptest::array::uniform24;
use proptest::prelude::*;
use tenax_logic::hebbian::{
    Activation, Activations, Code, Codes, Config, FingertipNetwork, Normaliser, NormaliserConfig, RECEPTORS,
    Rule, Sense,
};

use super::oracle::weights_of;

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
    let rule = Rule::new(config).unwrap();
    let mut network = FingertipNetwork::default();
    for (t, codes) in lessons {
        network.learn(&rule, &felt(t), codes);
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
    fn weights_and_outputs_are_bounded(config in configs(), lessons in lessons(), codes in [code(), code()]) {
        let network = taught(&config, &lessons);
        // |w| never exceeds alpha / beta, nor the limit.
        let bound = f64::from(config.alpha_ppb) / f64::from(config.beta_ppb.max(1));
        for w in weights_of(&network).iter().flatten() {
            prop_assert!(w.abs() <= bound.min(8.0) * (1.0 + 1e-6) + 1e-7, "{w} {bound}");
        }
        for (t, _) in &lessons {
            for output in network.output(&felt(t), &codes) {
                prop_assert!(output.as_f64().abs() <= 1.0);
            }
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
                prop_assert_eq!(swapped.weight(output, j), straight.weight(output, from));
            }
        }
        let (t, codes) = &lessons[0];
        prop_assert_eq!(straight.output(&felt(t), codes), swapped.output(&felt(&permuted(t)), codes));
    }

    #[test]
    fn no_reading_can_break_the_normaliser(
        readings in prop::collection::vec((uniform24(any::<i32>()), uniform24(any::<i32>())), 1..20),
        floor in any::<u32>(), ceiling in any::<u32>(), average_shift in any::<u32>(),
    ) {
        let config = NormaliserConfig { floors: [floor; RECEPTORS], ceiling, average_shift, ..NORMALISER };
        let mut normaliser = Normaliser::new(&config);
        for (raw, zero) in readings {
            normaliser.observe(&config, &raw);
            prop_assert!(normaliser.maxima().iter().all(|&m| m >= 1 && m <= ceiling.max(1)));
            let activations = normaliser.activations(&config, &raw);
            prop_assert!(activations.as_bits().iter().all(|t| t.abs() <= 1 << 26));
            normaliser.zero(&zero);
        }
    }
}
