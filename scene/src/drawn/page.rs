//! A world's scene file, written line by line as it is drawn.

use std::fmt::Write;

use super::Family;
use super::ranges::{self, Law};
use crate::physics::GRAVITY_M_S2;
use crate::random::{Noise, Source};

/// When the wearer begins to close, s.
const GRASPS_S: f64 = 0.8;
/// Part of its speed at which the hand closes under [`ranges::CLOSING_MV`], and how long it runs on after the muscle beside its dead
/// time, s: measured on `scenes/glass.toml`.
const CLOSING_PART: f64 = 0.3;
const RUNS_ON_S: f64 = 0.025;
/// The wearer feels no less than this, N.
const FEELS_N: f64 = 0.1;
/// Nobody grasps what their own grip breaks: it bears so many times as much.
const BEARS_GRIP: f64 = 1.3;
pub(super) const HAPPENS_S: f64 = 5.5;
const LIFTS_M: f64 = 0.2;
/// A swinging hand stays above the table, m.
const SWINGS_M: f64 = 0.12;
/// The wearer's grip presses no object in by more than this part of its width.
const PRESSED_PART: f64 = 0.25;
/// Pads that were wet before slide more easily still.
const WET_MU_D_PART: f64 = 0.05;
const LEAST_MU: f64 = 0.05;

pub(super) struct Page {
    pub(super) text: String,
    noise: Noise,
    pub(super) seed: u64,
    /// For so long something may happen after the grasp, s.
    happens_s: f64,
}

/// What the events of a world are drawn around.
struct Held {
    mu_s: f64,
    mu_d_part: f64,
    mass_kg: f64,
    /// From when on something may happen, s.
    from_s: f64,
}

impl Page {
    pub(super) fn new(seed: u64, happens_s: f64) -> Self {
        Self { text: String::new(), noise: Noise::new(seed, Source::Drawn), seed, happens_s }
    }

    pub(super) fn put(&mut self, line: std::fmt::Arguments<'_>) {
        writeln!(self.text, "{line}").expect("a string takes all");
    }

    /// A table, or an entry of a list, with its numbers to four places.
    fn table(&mut self, head: &str, numbers: &[(&str, f64)]) {
        self.put(format_args!("\n{head}"));
        numbers.iter().for_each(|(key, value)| self.number(key, *value));
    }

    fn number(&mut self, key: &str, value: f64) {
        self.put(format_args!("{key} = {}", (value * 1e4).round() / 1e4));
    }

    /// More keys of the last table, each drawn.
    fn drawn(&mut self, laws: &[(&str, Law)]) {
        for (key, law) in laws {
            let value = self.draw(*law);
            self.number(key, value);
        }
    }

    fn draw(&mut self, law: Law) -> f64 {
        law.draw(&mut self.noise)
    }

    fn happens(&mut self, part: f64) -> bool {
        self.noise.between(0.0, 1.0) < part
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.noise.between(low, high)
    }

    pub(super) fn world(&mut self, family: Family) {
        let held = self.grasp(family);
        match family {
            Family::QuietHold => {}
            Family::DisturbedHold => self.disturbed(&held),
            Family::Splash => self.splash(held.from_s, &held),
            Family::Condensation => self.condensation(&held),
            Family::Pour => self.pour(&held),
            Family::DropInAndTug if self.happens(0.5) => self.drop_in(&held),
            Family::DropInAndTug => self.tug(&held),
            Family::WalkAndSwing => self.walk(&held),
            Family::FragileAndSlippery | Family::OffCentre => match self.between(0.0, 4.0) as u32 {
                0 => self.splash(held.from_s, &held),
                1 => self.pour(&held),
                2 => self.tug(&held),
                _ => self.walk(&held),
            },
            Family::WearersWill => self.will(&held),
        }
        if family != Family::DisturbedHold && self.happens(ranges::KNOCK_PART) {
            self.knock(held.from_s, HAPPENS_S);
        }
    }

    /// Object, hand and sensors; the wearer grasps and lifts.
    fn grasp(&mut self, family: Family) -> Held {
        let noise = &mut self.noise;
        let (mass_kg, deviate) = ranges::MASS_KG.beside(noise, 0.0, 0.0);
        let (width_mm, _) = ranges::WIDTH_MM.beside(noise, ranges::MASS_WITH_WIDTH, deviate);
        let (stiffness_n_per_mm, deviate) = ranges::STIFFNESS_N_PER_MM.beside(noise, 0.0, 0.0);
        let (yields_n, _) = ranges::CRUSH_N.beside(noise, ranges::CRUSH_WITH_STIFFNESS, deviate);
        let slippery = family == Family::FragileAndSlippery;
        let mu_s = if slippery { ranges::OILY_MU_S } else { ranges::MU_S }.draw(noise);
        let mu_d_part = ranges::mu_d_part(noise);
        let yields = slippery || self.happens(ranges::CRUSH_PART);
        let (hand_n, speed_mm_s) = (self.draw(ranges::HAND_N), self.draw(ranges::HAND_MM_S));
        let dead_time_ms = self.draw(ranges::DEAD_TIME_MS);
        let gap_mm = self.draw(ranges::GAP_MM);
        let needed_n = mass_kg * GRAVITY_M_S2 / 2.0 / mu_s;
        let wanted_n = (self.draw(ranges::GRIP_OVER_NEED) * needed_n).min(0.6 * hand_n);
        let stiffness_n_per_mm = stiffness_n_per_mm.max(2.0 * wanted_n / (PRESSED_PART * width_mm));
        // The wearer knows how far the hand runs on, and lets go so much earlier.
        let closing_n_s = CLOSING_PART * speed_mm_s * stiffness_n_per_mm / 2.0;
        let runs_on_n = closing_n_s * (dead_time_ms / 1e3 + RUNS_ON_S);
        let until_n = (wanted_n - runs_on_n).max(FEELS_N);
        let yields_n = yields_n.max(BEARS_GRIP * (until_n + runs_on_n));
        // Minimum jerk: its peak is 5.77 times the way over the square of the time.
        let lift_s = (5.77 * LIFTS_M / self.draw(ranges::LIFT_M_S2)).sqrt();
        // The more of its force it needs, the slower it closes.
        let slows = 1.0 - until_n / (CLOSING_PART * hand_n);
        let closes_s = gap_mm / (CLOSING_PART * speed_mm_s) + until_n / closing_n_s / slows.max(0.2) + 0.4;
        let lifts_s = GRASPS_S + closes_s + 0.2;
        let from_s = lifts_s + lift_s + 0.3;

        self.put(format_args!(
            "name = \"drawn\"\ntitle = \"{}\"\nfrom = \"drawn, scene/src/drawn\"\nslip_floor_mm_s = 1.0",
            family.name()
        ));
        self.put(format_args!("duration_s = {:.3}", from_s + self.happens_s + 0.5));
        let level = if self.happens(ranges::BRUSH_PART) { "l1" } else { "l0" };
        let pitch_mm = self.draw(ranges::PITCH_MM);
        self.table(
            "[contact]",
            &[("mu_s", mu_s), ("mu_d", mu_s * mu_d_part), ("pad_length_mm", 18.0), ("pitch_mm", pitch_mm)],
        );
        self.put(format_args!("level = \"{level}\""));
        self.table(
            "[object]",
            &[("mass_kg", mass_kg), ("width_mm", width_mm), ("stiffness_n_per_mm", stiffness_n_per_mm)],
        );
        if yields {
            let how = if self.happens(0.5) { "crush_n" } else { "break_n" };
            self.put(format_args!("{how} = {yields_n:.2}"));
        }
        if family == Family::OffCentre && self.happens(0.5) {
            let (offset_mm, hang_mm) = (self.draw(ranges::MASS_ASIDE_MM), self.draw(ranges::HANGS_MM));
            let gyration_mm = (self.draw(ranges::GYRATION_PART) * width_mm).max(hang_mm);
            self.table(
                "[pitch]",
                &[("offset_mm", offset_mm), ("hang_mm", hang_mm), ("gyration_mm", gyration_mm)],
            );
        }
        self.table(
            "[gripper]",
            &[
                ("speed_mm_s", speed_mm_s),
                ("force_n", hand_n),
                ("dead_time_ms", dead_time_ms),
                ("range_mm", 110.0),
                ("opening_mm", width_mm + gap_mm),
            ],
        );
        self.sensors(family);
        let level_mv = self.draw(ranges::CLOSING_MV);
        self.muscle(GRASPS_S, closes_s, "close", level_mv);
        self.put(format_args!("until_grip_n = {until_n:.3}"));
        self.table("[[move]]", &[("at_s", lifts_s), ("for_s", lift_s), ("to_mm", 1e3 * LIFTS_M)]);
        Held { mu_s, mu_d_part, mass_kg, from_s }
    }

    fn sensors(&mut self, family: Family) {
        let law = if family == Family::OffCentre { ranges::FAR_ASIDE_MM } else { ranges::ASIDE_MM };
        let aside_mm = [self.draw(law), self.draw(law)];
        let gains: [f64; 4] = std::array::from_fn(|_| self.draw(ranges::QUADRANT_GAIN));
        self.put(format_args!("\n[fsr]\naside_mm = {aside_mm:.3?}\ngains = {gains:.3?}"));
        self.drawn(&[
            ("hysteresis", ranges::HYSTERESIS),
            ("creep", ranges::CREEP),
            ("noise", ranges::FSR_NOISE),
        ]);
        let factor = self.draw(ranges::FILM_FACTOR);
        let mains_hz = self.mains_hz();
        self.table("[pvdf]", &[("mains_hz", mains_hz)]);
        let scenes = [("normal", 2.0), ("shear", 3.0), ("release", 200.0), ("texture", 40.0)];
        scenes.iter().for_each(|(what, gain)| self.number(&format!("{what}_mv_per_n"), factor * gain));
        self.drawn(&[
            ("motor_hz", ranges::GEAR_HZ),
            ("motor_mv", ranges::GEAR_MV),
            ("mains_mv", ranges::MAINS_MV),
            ("noise_mv", ranges::FILM_NOISE_MV),
            ("film_decades", ranges::FILM_DECADES),
        ]);
        self.table("[myo]", &[]);
        self.drawn(&[
            ("noise_mv", ranges::MYO_NOISE_MV),
            ("ripple", ranges::RIPPLE),
            ("crosstalk", ranges::CROSSTALK),
            ("mains_mv", ranges::MYO_MAINS_MV),
        ]);
        if mains_hz > 50.0 {
            // Whoever fits the hand tells it the mains of the country.
            self.put(format_args!("\n[[command]]\nat_s = 0.0\nkind = \"set-mains-60-hz-flag\"\nvalue = 1"));
        }
    }

    fn mains_hz(&mut self) -> f64 {
        if self.happens(0.5) { 50.0 } else { 60.0 }
    }

    fn muscle(&mut self, at_s: f64, for_s: f64, intent: &str, level_mv: f64) {
        self.table("[[muscle]]", &[("at_s", at_s), ("for_s", for_s), ("level_mv", level_mv)]);
        self.put(format_args!("intent = \"{intent}\""));
    }

    fn knock(&mut self, from_s: f64, for_s: f64) {
        let at_s = self.between(from_s, from_s + for_s);
        self.table("[[knock]]", &[("at_s", at_s)]);
        self.drawn(&[
            ("peak_mv", ranges::KNOCK_MV),
            ("ring_hz", ranges::KNOCK_HZ),
            ("decay_ms", ranges::KNOCK_MS),
            ("uneven", ranges::UNEVEN),
        ]);
    }

    /// The dry friction times `factor` from `at_s` on.
    fn wet(&mut self, at_s: f64, ramp_ms: f64, factor: f64, held: &Held) {
        let mu_s = (held.mu_s * factor).max(LEAST_MU);
        let mu_d = (mu_s * (held.mu_d_part - WET_MU_D_PART)).max(LEAST_MU);
        self.table("[[wet]]", &[("at_s", at_s), ("ramp_ms", ramp_ms), ("mu_s", mu_s), ("mu_d", mu_d)]);
    }

    fn disturbed(&mut self, held: &Held) {
        for _ in 0..self.between(1.0, 6.0) as u32 {
            self.knock(held.from_s, HAPPENS_S);
        }
        if self.happens(0.5) {
            let at_s = held.from_s + self.between(0.0, 2.0);
            self.hum(at_s, ranges::HUM_S);
        }
        if self.happens(0.5) {
            self.bump(held.from_s, [0.5, HAPPENS_S - 1.0]);
        }
    }

    fn hum(&mut self, at_s: f64, for_s: Law) {
        self.table("[[hum]]", &[("at_s", at_s)]);
        self.drawn(&[("peak_mv", ranges::MAINS_MV)]);
        let (hum_hz, for_s) = (self.mains_hz(), self.draw(for_s));
        self.number("hum_hz", hum_hz);
        self.number("for_s", for_s);
    }

    /// Minutes in which the wearer stands, walks or is driven; whatever else comes at its own rate.
    pub(super) fn day(&mut self, minutes: u32) {
        let held = self.grasp(Family::DisturbedHold);
        let [knocks, bumps, hums] =
            [ranges::KNOCKS_H, ranges::BUMPS_H, ranges::HUMS_H].map(|law| self.draw(law) / 3_600.0);
        let [walks, drives] = [self.between(0.0, 0.5), self.between(0.0, 0.2)];
        for minute in 0..minutes {
            let from_s = held.from_s + 60.0 * f64::from(minute);
            let kind = self.between(0.0, 1.0);
            let laws = if kind < walks {
                [ranges::WALK_HZ, ranges::WALK_M_S2]
            } else if kind < walks + drives {
                [ranges::DRIVE_HZ, ranges::DRIVE_M_S2]
            } else {
                [ranges::TREMOR_HZ, ranges::TREMOR_M_S2]
            };
            let ([rate, peak], for_s) = (laws.map(|law| self.draw(law)), self.draw(ranges::STRETCH_S));
            // A scene's swing has at most 255 cycles.
            self.swing(from_s, (for_s * rate).ceil().min(255.0), rate, peak);
            for s in 0..60 {
                let at_s = from_s + f64::from(s);
                if self.happens(knocks) {
                    self.knock(at_s, 1.0);
                }
                if self.happens(bumps) {
                    self.bump(at_s, [0.0, 1.0]);
                }
                if self.happens(hums) {
                    self.hum(at_s, ranges::STRETCH_S);
                }
            }
        }
        for film in 1..=12 {
            self.put(format_args!(
                "\n[[fault]]\nchannel = \"pvdf_{film}\"\nkind = \"drift\"\nreason = \"creep\""
            ));
            self.number("at_s", held.from_s);
            // Millivolts a second, to six places.
            let per_s = self.draw(ranges::FILM_DRIFT_MV_S);
            self.put(format_args!("drift_per_s = {per_s:.6}"));
        }
    }

    fn splash(&mut self, from_s: f64, held: &Held) {
        let at_s = from_s + self.between(0.2, 2.5);
        let ramp_ms = self.draw(ranges::SPLASH_MS);
        let kind = self.between(0.0, 1.0);
        let factor = if kind < ranges::OILY_PART {
            (self.draw(ranges::OILY_MU_S) / held.mu_s).min(1.0)
        } else if kind < ranges::OILY_PART + ranges::POWDER_PART {
            self.draw(ranges::POWDER_FACTOR)
        } else {
            self.draw(ranges::WET_FACTOR)
        };
        self.wet(at_s, ramp_ms, factor, held);
        if self.happens(ranges::AGAIN_PART) {
            let (again_s, ramp_ms) = (at_s + self.draw(ranges::AGAIN_S), self.draw(ranges::SPLASH_MS));
            let factor = factor * self.draw(ranges::WET_FACTOR).clamp(0.6, 1.0);
            self.wet(again_s, ramp_ms, factor, held);
        }
    }

    fn condensation(&mut self, held: &Held) {
        let for_s = self.draw(ranges::CONDENSATION_S).min(HAPPENS_S);
        let factor = self.draw(ranges::WET_FACTOR).min(1.0);
        let steps = (2.0 * for_s).ceil();
        for step in 0..steps as u32 {
            let done = f64::from(step + 1) / steps;
            let at_s = held.from_s + for_s * f64::from(step) / steps;
            self.wet(at_s, 1e3 * for_s / steps, 1.0 + done * (factor - 1.0), held);
        }
    }

    fn pour(&mut self, held: &Held) {
        let (rate_kg_s, for_s) = (self.draw(ranges::FILLING_KG_S), self.draw(ranges::POURS_S));
        let at_s = held.from_s + self.between(0.0, 0.8);
        // Nothing is poured into what could not hold it: a cup takes ten times its own mass.
        let add_kg = (rate_kg_s * for_s).min(10.0 * held.mass_kg);
        self.table("[[fill]]", &[("at_s", at_s), ("for_s", for_s), ("add_kg", add_kg)]);
        if self.happens(0.5) {
            let (ramp_ms, factor) = (self.draw(ranges::RUN_DOWN_MS), self.draw(ranges::WET_FACTOR));
            let at_s = at_s + for_s - self.between(0.0, 0.3);
            self.wet(at_s, ramp_ms, factor, held);
        }
    }

    fn drop_in(&mut self, held: &Held) {
        let [add_kg, from_mm, for_ms] =
            [ranges::DROPPED_KG, ranges::DROPPED_FROM_MM, ranges::DROPPED_MS].map(|law| self.draw(law));
        let add_kg = add_kg.min(ranges::DROPPED_PART * held.mass_kg);
        let (at_s, for_s) = (held.from_s + self.between(0.2, 3.0), for_ms / 1e3);
        self.table("[[fill]]", &[("at_s", at_s), ("for_s", for_s), ("add_kg", add_kg)]);
        // What falls in is stopped: m sqrt(2 g h) over the time of its landing.
        let stops_n = add_kg * (2.0 * GRAVITY_M_S2 * from_mm / 1e3).sqrt() / for_s;
        self.pull(at_s, for_s, -stops_n, for_ms / 4.0, false);
    }

    fn tug(&mut self, held: &Held) {
        let mut at_s = held.from_s + self.between(0.2, 2.0);
        for _ in 0..self.between(1.0, 3.0) as u32 {
            let [force_n, rate_n_s, for_s] =
                [ranges::TUG_N, ranges::TUG_N_S, ranges::TUG_S].map(|law| self.draw(law));
            let force_n = force_n.min(ranges::TUG_WEIGHTS * held.mass_kg * GRAVITY_M_S2);
            let ramp_ms = (1e3 * force_n / rate_n_s).clamp(1.0, 1e3);
            let down = if self.happens(0.75) { -1.0 } else { 1.0 };
            self.pull(at_s, for_s + ramp_ms / 1e3, down * force_n, ramp_ms, false);
            at_s += self.draw(ranges::AGAIN_S);
        }
    }

    fn pull(&mut self, at_s: f64, for_s: f64, force_n: f64, ramp_ms: f64, takes: bool) {
        let force_n = force_n.clamp(-200.0, 200.0);
        self.table(
            "[[pull]]",
            &[("at_s", at_s), ("for_s", for_s), ("force_n", force_n), ("ramp_ms", ramp_ms)],
        );
        self.put(format_args!("takes = {takes}"));
    }

    fn walk(&mut self, held: &Held) {
        let law = if self.happens(0.6) { ranges::WALK_M_S2 } else { ranges::SWING_M_S2 };
        let (peak_m_s2, rate_hz) = (self.draw(law), self.draw(ranges::WALK_HZ));
        let at_s = held.from_s + self.between(0.0, 1.0);
        let cycles = (self.between(1.0, 4.5) * rate_hz).ceil();
        self.swing(at_s, cycles, rate_hz, peak_m_s2);
        if self.happens(0.5) {
            self.bump(held.from_s, [0.5, HAPPENS_S - 1.0]);
        }
    }

    fn swing(&mut self, at_s: f64, cycles: f64, rate_hz: f64, peak_m_s2: f64) {
        let peak_m_s2 = peak_m_s2.min(SWINGS_M * (std::f64::consts::TAU * rate_hz).powi(2));
        self.table(
            "[[swing]]",
            &[("at_s", at_s), ("cycles", cycles), ("rate_hz", rate_hz), ("peak_m_s2", peak_m_s2)],
        );
    }

    /// The hand hits something: the object and the films feel it together.
    fn bump(&mut self, from_s: f64, [least_s, most_s]: [f64; 2]) {
        let [peak_m_s2, for_ms] = [ranges::BUMP_M_S2, ranges::BUMP_MS].map(|law| self.draw(law));
        let at_s = from_s + self.between(least_s, most_s);
        self.swing(at_s, 1.0, 1e3 / for_ms, peak_m_s2);
        self.knock(at_s, 1e-3);
    }

    fn will(&mut self, held: &Held) {
        let from_s = held.from_s;
        match self.between(0.0, 6.0) as u32 {
            // They open a little, and close again.
            0 => {
                let at_s = from_s + self.between(0.2, 2.0);
                let for_s = self.between(0.05, 0.25);
                self.muscle(at_s, for_s, "open", 900.0);
                self.muscle(at_s + for_s + 0.1, 0.5, "close", 500.0);
            }
            // Somebody takes it, and they let go.
            1 => {
                let (at_s, ramp_ms) = (from_s + self.between(0.5, 2.0), self.draw(ranges::HAND_OVER_MS));
                let force_n = self.between(1.0, 2.0) * held.mass_kg * GRAVITY_M_S2;
                self.pull(at_s, HAPPENS_S - 2.5, force_n, ramp_ms, true);
                self.muscle(at_s + ramp_ms / 1e3, 1.5, "open", 900.0);
            }
            // An electrode lifts, sometimes again; then the object is wetted.
            2 | 3 => {
                let channel = if self.happens(0.5) { "myo_flexor" } else { "myo_extensor" };
                let mut at_s = from_s;
                for _ in 0..self.between(1.0, 4.0) as u32 {
                    let for_s = self.draw(ranges::LIFTED_S);
                    self.table("[[electrode_lift]]", &[("at_s", at_s), ("for_s", for_s)]);
                    self.drawn(&[("pickup_mv", ranges::LIFTED_MV)]);
                    self.put(format_args!("channel = \"{channel}\""));
                    at_s += for_s + self.between(0.2, 1.0);
                    if at_s > from_s + 2.5 {
                        break;
                    }
                }
                self.splash(at_s.min(from_s + 3.0), held);
            }
            // Both muscles are tense, from the lift on or over a slip, or restless.
            4 => {
                let mut at_s = from_s - self.between(0.0, 1.5);
                for _ in 0..self.between(1.0, 4.0) as u32 {
                    let [level_mv, for_s] = [ranges::TENSE_MV, ranges::TENSE_S].map(|law| self.draw(law));
                    self.muscle(at_s, for_s, "both", level_mv);
                    at_s += for_s + self.between(0.2, 1.5);
                    if at_s > from_s + HAPPENS_S {
                        break;
                    }
                }
                self.splash(from_s, held);
            }
            // A slip, and one more while the hand closes.
            _ => {
                let at_s = from_s + self.between(0.2, 2.0);
                let [first, second] = [1.0, 0.8].map(|part| part * self.draw(ranges::WET_FACTOR).min(1.0));
                let ramps_ms = [self.draw(ranges::SPLASH_MS), self.draw(ranges::SPLASH_MS)];
                let again_s = at_s + self.between(0.05, 0.4);
                self.wet(at_s, ramps_ms[0], first, held);
                self.wet(again_s, ramps_ms[1], first * second, held);
            }
        }
    }
}
