//! The motor at the bridge: winding with resistance and inductance, and back-EMF. Voltage is a part of the supply's, current of the stall
//! current at the whole supply, speed of the idle speed. Of a PWM period only the mean in the steady state: a winding follows within 0.5 ms.

/// Period of the bridge's PWM, ms.
const PERIOD_MS: f64 = 0.05;
/// Drop of the two diodes through which a coasting motor feeds the supply (assumed: 1.4 V of 7.4 V).
const DIODES: f64 = 0.2;

/// State of the bridge between two pulses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decay {
    /// The motor is short-circuited; current goes on flowing.
    Slow,
    /// The motor coasts: its current flows into the supply, and ends where it reaches zero.
    Fast,
}

#[derive(Clone, Copy, Debug)]
pub struct Motor {
    pub decay: Decay,
    /// Inductance over resistance, ms (small brushed motors: 0.05 to 0.5).
    pub winding_ms: f64,
}

impl Default for Motor {
    fn default() -> Self {
        Self { decay: Decay::Slow, winding_ms: 0.2 }
    }
}

impl Motor {
    pub fn current(&self, duty: f64, speed: f64) -> f64 {
        if self.decay == Decay::Slow {
            return duty - speed;
        }
        let on_ms = duty * PERIOD_MS;
        let back = 1.0 + DIODES + speed;
        let peak = (1.0 - speed) * -(-on_ms / self.winding_ms).exp_m1();
        let off_ms = (self.winding_ms * (peak / back).ln_1p()).min(PERIOD_MS - on_ms);
        ((1.0 - speed) * on_ms - back * off_ms) / PERIOD_MS
    }

    /// Speed at which the motor carries a load; 0 under more than it can move.
    pub fn speed(&self, duty: f64, load: f64) -> f64 {
        if self.decay == Decay::Slow {
            return (duty - load).max(0.0);
        }
        let (mut slow, mut fast) = (0.0, 1.0);
        for _ in 0..20 {
            let middle = f64::midpoint(slow, fast);
            *(if self.current(duty, middle) > load { &mut slow } else { &mut fast }) = middle;
        }
        slow
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WINDINGS_MS: [f64; 4] = [0.05, 0.1, 0.2, 0.5];

    /// Mean current of the last of many PWM periods, by Euler's method.
    fn stepped(motor: Motor, duty: f64, speed: f64) -> f64 {
        const STEPS: u32 = 5_000;
        let step_ms = PERIOD_MS / f64::from(STEPS);
        let (mut current, mut sum) = (0.0, 0.0);
        for _ in 0..100 {
            sum = 0.0;
            for step in 0..STEPS {
                let voltage = match motor.decay {
                    _ if f64::from(step) < duty * f64::from(STEPS) => 1.0,
                    Decay::Slow => 0.0,
                    Decay::Fast => -1.0 - DIODES,
                };
                let next = current + (voltage - current - speed) * step_ms / motor.winding_ms;
                // Diodes let no current flow back.
                current = if voltage < 0.0 { f64::max(next, 0.0) } else { next };
                sum += current;
            }
        }
        sum / f64::from(STEPS)
    }

    // Shows B9.
    #[test]
    fn a_blocked_motor_gets_its_duty_only_if_it_is_short_circuited_between_pulses() {
        for winding_ms in WINDINGS_MS {
            for duty in [0.1, 0.3, 0.4] {
                let part = |decay| Motor { decay, winding_ms }.current(duty, 0.0) / duty;
                assert!(part(Decay::Slow) >= 0.8, "{winding_ms} ms, {duty}");
                assert!(part(Decay::Fast) < 0.35, "{winding_ms} ms, {duty}: {}", part(Decay::Fast));
            }
        }
    }

    #[test]
    fn the_mean_current_is_that_of_a_period_in_steps() {
        for decay in [Decay::Slow, Decay::Fast] {
            for (winding_ms, duty, speed) in [
                (0.05, 0.3, 0.0),
                (0.5, 0.3, 0.0),
                (0.2, 0.4, 0.2),
                (0.1, 0.8, 0.1),
                (0.5, 0.9, 0.0),
                (0.2, 1.0, 0.5),
            ] {
                let motor = Motor { decay, winding_ms };
                let (mean, stepped) = (motor.current(duty, speed), stepped(motor, duty, speed));
                assert!((mean - stepped).abs() < 1e-3, "{motor:?}, {duty}, {speed}: {mean}, {stepped}");
                let carried = motor.current(duty, motor.speed(duty, mean.max(0.0)));
                assert!((carried - mean.max(0.0)).abs() < 1e-5, "{motor:?}, {duty}: {carried}");
            }
        }
    }
}
