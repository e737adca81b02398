//! Calibration of the force sensor with known weights: its zero and its gain.

use std::collections::VecDeque;
use std::time::Duration;

use tenax_hal_shim::channel::SLOW_HZ;
use tenax_hal_shim::wire::Down;

use super::{Say, ask, forces, wait_for};
use tenax_frames::link::Client;

/// Slow frames in which a steady reading stands still: 1 s.
const STEADY: usize = SLOW_HZ as usize;
/// Largest distance of a steady reading from its mean: part of the mean, and N.
const STILL_PART: f64 = 0.03;
const STILL_N: f64 = 0.04;
/// Range of the readings of a weight, parts of it.
const BETWEEN: (f64, f64) = (0.5, 2.0);
/// Part of a weight below which it is taken off.
const OFF_PART: f64 = 0.1;
const PATIENCE: Duration = Duration::from_secs(120);
/// Largest error of a gain that needs no change.
const GAIN_OFF: f64 = 0.05;
/// Standard gravity, m/s^2.
const GRAVITY: f64 = 9.806_65;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Weighed {
    true_n: f64,
    read_n: f64,
}

fn report(weighed: &[Weighed]) -> String {
    let sum = |product: fn(&Weighed) -> f64| weighed.iter().map(product).sum::<f64>();
    // The reading of 1 N, by least squares through no load.
    let gain = sum(|own| own.read_n * own.true_n) / sum(|own| own.true_n * own.true_n);
    let mut text =
        format!("{:>10}{:>10}{:>12}{:>16}\n", "weight, N", "read, N", "error, %", "off the line, %");
    let mut worst = 0.0_f64;
    for Weighed { true_n, read_n } in weighed {
        let [error, off] = [*true_n, gain * true_n].map(|expected| 100.0 * (read_n - expected) / true_n);
        text += &format!("{true_n:>10.3}{read_n:>10.3}{error:>12.1}{off:>16.1}\n");
        worst = worst.max(off.abs());
    }
    text += &format!("the board reads {gain:.3} N for 1 N; off that line by {worst:.1} % at most\n");
    if worst > 10.0 {
        text + "the line is not straight: another sensor, another resistor beside it, or a weight off its middle"
    } else if (gain - 1.0).abs() > GAIN_OFF {
        text + "change the amplifier by the inverse of that: until then every force that the board shows is that much off"
    } else {
        text + "within 5 %: nothing to do. The zero is kept on the board"
    }
}

/// Zeroes the unloaded finger, asks for one weight after the other and tells the errors. Fails if the board refuses, or a weight never comes.
pub fn calibrate(client: &mut Client, weights_n: &[f64], say: Say<'_>) -> anyhow::Result<()> {
    say("Nothing may touch the finger.")?;
    wait_for(client, PATIENCE, "a finger that nothing touches", steady(-1.0, 0.5))?;
    ask(client, Down::Zero)?;
    say("Zeroed.")?;
    let mut weighed = Vec::new();
    for (n, &true_n) in (1..).zip(weights_n) {
        let grams = 1e3 * true_n / GRAVITY;
        say(&format!(
            "{n} of {}: put on {true_n} N ({grams:.0} g), on the middle, and let go.",
            weights_n.len()
        ))?;
        let (least, most) = (BETWEEN.0 * true_n, BETWEEN.1 * true_n);
        let read_n =
            wait_for(client, PATIENCE, &format!("a steady load of about {true_n} N"), steady(least, most))?;
        say(&format!("   reads {read_n:.3} N. Take it off."))?;
        wait_for(client, PATIENCE, "the weight to be taken off", |message| {
            let load = forces(message).map(|forces| f64::from(forces.load_mn) / 1e3);
            Ok(load.filter(|&load| load < OFF_PART * true_n))
        })?;
        weighed.push(Weighed { true_n, read_n });
    }
    say(&format!("\n{}", report(&weighed)))
}

/// Finds the load that has stood still between these, N.
fn steady(least: f64, most: f64) -> impl FnMut(&tenax_hal_shim::wire::Up) -> anyhow::Result<Option<f64>> {
    let mut loads: VecDeque<f64> = VecDeque::new();
    move |message| {
        let Some(forces) = forces(message) else { return Ok(None) };
        if loads.len() == STEADY {
            loads.pop_front();
        }
        loads.push_back(f64::from(forces.load_mn) / 1e3);
        let mean = loads.iter().sum::<f64>() / loads.len() as f64;
        let still = (STILL_PART * mean).max(STILL_N);
        let stands = loads.len() == STEADY && loads.iter().all(|load| (load - mean).abs() <= still);
        Ok((stands && (least..=most).contains(&mean)).then_some(mean))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What else is told: `tests/calibrate.rs`.
    #[test]
    fn a_curve_is_told_from_a_gain() {
        let weighed = [1.0, 2.0, 5.0].map(|true_n: f64| Weighed { true_n, read_n: true_n * true_n.sqrt() });
        assert!(report(&weighed).contains("not straight"));
    }
}
