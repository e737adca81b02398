//! A million updates in fixed point and in `f64`, side by side.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_logic::hebbian::{Activation, Activations, Code, Codes, Config, FingertipNetwork, RECEPTORS, Rule};

use super::oracle::{FULL_SCALE, Rates, Reference, exact, outputs, weights_of};
use super::task::Finger;

const UPDATES: usize = 1_000_000;

/// Largest errors of weights (relative to full scale) and of outputs, sampled every 97 updates and at the end.
fn worst(config: Config, mut input: impl FnMut(usize) -> (Activations<RECEPTORS>, Codes)) -> (f64, f64) {
    let rule = Rule::of(&config);
    let rates = Rates::from(&config);
    let (mut fixed, mut reference) = (FingertipNetwork::default(), Reference::default());
    let (mut of_weights, mut of_outputs) = (0.0f64, 0.0f64);
    for n in 1..=UPDATES {
        let (felt, codes) = input(n);
        let t = exact(&felt);
        if n % 97 == 0 || n == UPDATES {
            for (fixed, exact) in outputs(&fixed, &felt).iter().zip(reference.output(&t, &[Code::Zero; 2])) {
                of_outputs = of_outputs.max((fixed - exact).abs());
            }
            for (fixed, exact) in weights_of(&fixed).iter().flatten().zip(reference.weights.iter().flatten())
            {
                of_weights = of_weights.max((fixed - exact).abs() / FULL_SCALE);
            }
        }
        fixed.learn(&rule, &felt, &codes.map(Some));
        reference.learn(&rates, &t, &codes);
    }
    (of_weights, of_outputs)
}

fn holds((of_weights, of_outputs): (f64, f64)) {
    assert!(of_weights < 1e-3, "weights {of_weights:e} of full scale");
    assert!(of_outputs < 1e-3, "outputs {of_outputs:e}");
}

fn betas(delta_ppm: u32, alpha_ppb: u32) -> impl Iterator<Item = Config> {
    let all = [0, 1_000, *Config::BETA_PPB.end()];
    all.into_iter().map(move |beta_ppb| Config { alpha_ppb, beta_ppb, delta_ppm })
}

#[test]
fn the_task_over_and_over() {
    let lesson = Finger::new(1).lesson();
    let mut moments = lesson.iter().filter_map(|m| Some((m.felt, m.lesson()?))).cycle();
    holds(worst(Config::default(), |_| moments.next().unwrap()));
}

#[test]
fn constant_inputs_at_every_corner_of_the_rates() {
    let slope = Activations::new(std::array::from_fn(|j| Activation::from_f64(1.0 - j as f64 / 12.0)));
    let full = Activations::new([Activation::from_f64(1.0); RECEPTORS]);
    for (delta_ppm, felt) in [(*Config::DELTA_PPM.start(), slope), (*Config::DELTA_PPM.end(), full)] {
        for alpha_ppb in [1_000, *Config::ALPHA_PPB.end()] {
            for config in betas(delta_ppm, alpha_ppb) {
                holds(worst(config, |_| (felt, [Code::Plus, Code::Minus])));
            }
        }
    }
}

/// Inputs without meaning: the weights wander, and only forgetting holds them. Where steps are sixty times delta and nothing is
/// forgotten, noise decides which connection wins: two exact networks 1e-9 apart end more than 1e-3 of full scale apart.
#[test]
fn noise_at_usual_rates_and_at_the_largest_alpha() {
    let largest = *Config::ALPHA_PPB.end();
    let forgetful = Config { alpha_ppb: largest, beta_ppb: *Config::BETA_PPB.end(), delta_ppm: 1_000 };
    let usual = betas(*Config::DELTA_PPM.start(), 1_000_000).chain(betas(1_000_000, 1_000_000));
    for config in usual.chain(betas(1_000_000, largest)).chain([forgetful]) {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let code = |n: usize, period| Code::from_sign((n / period % 3) as i32 - 1);
        holds(worst(config, |n| {
            let felt = std::array::from_fn(|_| Activation::from_f64(rng.random_range(-1.0..1.0)));
            (Activations::new(felt), [code(n, 331), code(n, 773)])
        }));
    }
}
