//! A million updates in fixed point and in `f64`, side by side.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_logic::hebbian::{Activation, Activations, Code, Codes, Config, FingertipNetwork, RECEPTORS, Rule};

use super::oracle::{FULL_SCALE, Rates, Reference, exact, weights_of};
use super::task::Finger;

const UPDATES: usize = 1_000_000;

/// Largest differences of weights (of full scale) and of outputs, looked at every 97 updates and at the end.
fn worst(config: Config, mut input: impl FnMut(usize) -> (Activations<RECEPTORS>, Codes)) -> (f64, f64) {
    let rule = Rule::new(&config).unwrap();
    let rates = Rates::from(&config);
    let (mut fixed, mut reference) = (FingertipNetwork::default(), Reference::default());
    let (mut of_weights, mut of_outputs) = (0.0f64, 0.0f64);
    for n in 1..=UPDATES {
        let (felt, codes) = input(n);
        let t = exact(&felt);
        if n % 97 == 0 || n == UPDATES {
            let outputs = fixed.output(&felt, &[Code::Zero; 2]).map(|o| o.as_f64());
            for (fixed, exact) in outputs.iter().zip(reference.output(&t, &[Code::Zero; 2])) {
                of_outputs = of_outputs.max((fixed - exact).abs());
            }
            for (fixed, exact) in weights_of(&fixed).iter().flatten().zip(reference.weights.iter().flatten())
            {
                of_weights = of_weights.max((fixed - exact).abs() / FULL_SCALE);
            }
        }
        fixed.learn(&rule, &felt, &codes);
        reference.learn(&rates, &t, &codes);
    }
    println!("{config:?}: weights {of_weights:.1e} of full scale, outputs {of_outputs:.1e}");
    (of_weights, of_outputs)
}

fn holds((of_weights, of_outputs): (f64, f64)) {
    assert!(of_weights < 1e-3, "weights {of_weights:e} of full scale");
    assert!(of_outputs < 1e-3, "outputs {of_outputs:e}");
}

fn codes(n: usize) -> Codes {
    let code = |period: usize| Code::from_sign((n / period % 3) as i32 - 1);
    [code(331), code(773)]
}

/// Every corner of the ranges of alpha, beta and delta, and their usual values.
fn corners(deltas_ppm: &[u32], alphas_ppb: &[u32]) -> Vec<Config> {
    let mut configs = Vec::new();
    for &delta_ppm in deltas_ppm {
        for &alpha_ppb in alphas_ppb {
            for beta_ppb in [0, 1_000, *Config::BETA_PPB.end()] {
                configs.push(Config { alpha_ppb, beta_ppb, delta_ppm });
            }
        }
    }
    configs
}

#[test]
fn the_task_over_and_over() {
    let lesson = Finger::new(1).lesson();
    let mut moments = lesson.iter().filter_map(|m| Some((m.felt, m.lesson()?))).cycle();
    holds(worst(Config::default(), |_| moments.next().unwrap()));
}

#[test]
fn constant_inputs_with_the_smallest_delta() {
    let felt = Activations::new(std::array::from_fn(|j| Activation::from_f64(1.0 - j as f64 / 12.0)));
    for config in corners(&[*Config::DELTA_PPM.start()], &[1_000, *Config::ALPHA_PPB.end()]) {
        holds(worst(config, |_| (felt, [Code::Plus, Code::Minus])));
    }
}

#[test]
fn constant_inputs_with_the_largest_delta() {
    let felt = Activations::new([Activation::from_f64(1.0); RECEPTORS]);
    for config in corners(&[*Config::DELTA_PPM.end()], &[1_000, *Config::ALPHA_PPB.end()]) {
        holds(worst(config, |_| (felt, [Code::Plus, Code::Minus])));
    }
}

/// Inputs without any meaning: the weights wander, and only forgetting holds them.
fn noise() -> impl FnMut(usize) -> (Activations<RECEPTORS>, Codes) {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    move |n| {
        let felt = std::array::from_fn(|_| Activation::from_f64(rng.random_range(-1.0..1.0)));
        (Activations::new(felt), codes(n))
    }
}

#[test]
fn noise_and_usual_rates() {
    for config in corners(&[*Config::DELTA_PPM.start(), 1_000_000], &[1_000_000]) {
        holds(worst(config, noise()));
    }
}

#[test]
fn noise_and_the_largest_alpha() {
    let (alpha_ppb, delta_ppm) = (*Config::ALPHA_PPB.end(), 1_000_000);
    for config in corners(&[delta_ppm], &[alpha_ppb]) {
        holds(worst(config, noise()));
    }
    holds(worst(Config { alpha_ppb, beta_ppb: *Config::BETA_PPB.end(), delta_ppm: 1_000 }, noise()));
}

/// Where steps are sixty times delta and nothing is forgotten, noise decides which connection wins, and the equations
/// themselves forget their beginning: two exact networks 1e-9 apart end up far apart. No arithmetic can follow there.
#[test]
fn noise_alone_decides_when_alpha_is_much_larger_than_delta() {
    for beta_ppb in [0, 1_000] {
        let config = Config { alpha_ppb: *Config::ALPHA_PPB.end(), beta_ppb, delta_ppm: 1_000 };
        let rates = Rates::from(&config);
        let mut input = noise();
        let (mut one, mut other) =
            (Reference::<RECEPTORS, 2>::default(), Reference::<RECEPTORS, 2>::default());
        other.weights = [[1e-9; RECEPTORS]; 2];
        for n in 1..=UPDATES {
            let (felt, codes) = input(n);
            let t = exact(&felt);
            one.learn(&rates, &t, &codes);
            other.learn(&rates, &t, &codes);
        }
        let apart = one.weights.iter().flatten().zip(other.weights.iter().flatten());
        let apart = apart.fold(0.0f64, |apart, (a, b)| apart.max((a - b).abs() / FULL_SCALE));
        println!("{config:?}: exact networks 1e-9 apart end {apart:.1e} of full scale apart");
        assert!(apart > 1e-3);
    }
}

/// Activations of a few thousandths, alpha of 1 ppm: a 16-bit weight would never move.
#[test]
fn the_smallest_useful_update_survives() {
    let config = Config { alpha_ppb: 1_000, beta_ppb: 100, delta_ppm: 1_000 };
    let felt = Activations::new(std::array::from_fn(|j| Activation::from_f64(0.001 * (j + 1) as f64)));
    let rule = Rule::new(&config).unwrap();
    let (mut fixed, mut reference) = (FingertipNetwork::default(), Reference::default());
    for _ in 0..UPDATES {
        fixed.learn(&rule, &felt, &[Code::Plus, Code::Minus]);
        reference.learn(&Rates::from(&config), &exact(&felt), &[Code::Plus, Code::Minus]);
    }
    for (fixed, exact) in weights_of(&fixed).iter().flatten().zip(reference.weights.iter().flatten()) {
        assert!((fixed / exact - 1.0).abs() < 0.02, "{fixed:e} for {exact:e}");
    }
}
