//! The force sensor under known weights: its zero, and how far what it reads is off.

use std::collections::VecDeque;
use std::time::Duration;

use tenax_hal_shim::channel::SLOW_HZ;
use tenax_hal_shim::wire::Down;
use tenax_logic::setting::SettingId;

use super::{Say, ask, forces, wait_for};
use tenax_frames::link::Client;

/// A reading counts once it has stood still for so many slow frames: one second.
const STEADY: usize = SLOW_HZ as usize;
/// Still: all of them within this part of their mean, or within so much, N.
const STILL_PART: f64 = 0.03;
const STILL_N: f64 = 0.04;
/// It is this weight if it reads between these parts of it.
const BETWEEN: (f64, f64) = (0.5, 2.0);
/// Taken off: less than this part of it is left.
const OFF_PART: f64 = 0.1;
/// How long a person may take.
const PATIENCE: Duration = Duration::from_secs(120);
/// A gain that is further from 1 is worth changing something.
const GAIN_OFF: f64 = 0.05;
/// The settings that are compared with what the sensor reads as a force.
const COMPARED: [SettingId; 2] = [SettingId::ForceCeiling, SettingId::Loaded];
/// Standard gravity, m/s^2.
const GRAVITY: f64 = 9.806_65;

/// A weight, and what the board read, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weighed {
    pub true_n: f64,
    /// What the board says.
    pub read_n: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// Every weight, in its order.
    pub weighed: Vec<Weighed>,
}

impl Calibration {
    /// What the board reads for 1 N, by least squares through no load.
    pub fn gain(&self) -> f64 {
        let sum = |product: fn(&Weighed) -> f64| self.weighed.iter().map(product).sum::<f64>();
        sum(|own| own.read_n * own.true_n) / sum(|own| own.true_n * own.true_n)
    }

    /// How far each reading is from its weight, and how far from the straight line through them, % of the weight.
    pub fn residuals(&self) -> impl Iterator<Item = (Weighed, f64, f64)> {
        let gain = self.gain();
        self.weighed.iter().map(move |&own| {
            let percent = |expected: f64| 100.0 * (own.read_n - expected) / own.true_n;
            (own, percent(own.true_n), percent(gain * own.true_n))
        })
    }

    /// The table, and what follows from it.
    pub fn text(&self) -> String {
        let mut text =
            format!("{:>10}{:>10}{:>12}{:>16}\n", "weight, N", "read, N", "error, %", "off the line, %");
        for (Weighed { true_n, read_n }, error, off) in self.residuals() {
            text += &format!("{true_n:>10.3}{read_n:>10.3}{error:>12.1}{off:>16.1}\n");
        }
        let gain = self.gain();
        let worst = self.residuals().map(|(_, _, off)| off.abs()).fold(0.0, f64::max);
        text += &format!("the board reads {gain:.3} N for 1 N; off that line by {worst:.1} % at most\n");
        text += &if worst > 10.0 {
            "the line is not straight: another sensor, another resistor beside it, or a weight off its middle\n".into()
        } else if (gain - 1.0).abs() > GAIN_OFF {
            format!(
                "change the amplifier by the inverse of that. Until then every force that the board shows is that much off, and\n\
                 \u{20} tenax config set{}\n\
                 has the hand do at these forces what the defaults say\n",
                self.settings()
            )
        } else {
            String::from("within 5 %: nothing to do. The zero is kept on the board\n")
        };
        text
    }

    /// The settings that the reflex compares a load with, as if the sensor read right. Not a gain on the board: a wrong one would move
    /// the ceiling far more than a setting of it may.
    fn settings(&self) -> String {
        let scaled = COMPARED.map(|id| {
            let row = id.row();
            let value = (f64::from(row.default) * self.gain()).round() as i32;
            format!(" {}={}", row.name, value.clamp(row.min, row.max))
        });
        scaled.concat()
    }
}

/// Zeroes the unloaded finger, then has one weight after the other put on it. Fails if the board refuses, or a weight never comes.
pub fn calibrate(client: &mut Client, weights_n: &[f64], say: Say<'_>) -> anyhow::Result<Calibration> {
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
    Ok(Calibration { weighed })
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

    #[test]
    fn a_gain_is_told_from_a_curve() {
        let of = |read: fn(f64) -> f64| Calibration {
            weighed: [1.0, 2.0, 5.0].map(|true_n| Weighed { true_n, read_n: read(true_n) }).to_vec(),
        };
        let straight = of(|n| 1.2 * n);
        assert!((straight.gain() - 1.2).abs() < 1e-9);
        assert!(straight.residuals().all(|(_, error, off)| (error - 20.0).abs() < 1e-6 && off.abs() < 1e-6));
        assert!(straight.text().contains("change the amplifier"), "{}", straight.text());
        let told = straight.text();
        assert!(told.contains("\n  tenax config set force-ceiling-mn=48000 loaded-mn=700\n"), "{told}");
        // At most what a setting may be: an earlier ceiling or load is the safe side.
        assert!(of(|n| 1.8 * n).text().contains("force-ceiling-mn=60000 "));
        assert!(of(|n| n * n.sqrt()).text().contains("not straight"));
        assert!(of(|n| 1.01 * n).text().contains("nothing to do"));
    }
}
