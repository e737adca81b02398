//! The motor-driven hand: two opposing fingers, after the Ottobock gripper of Prosthesis, section 1.

use std::collections::VecDeque;

use tenax_hal_shim::channel::SCANS_PER_FRAME;
use tenax_hal_shim::motor::{Duty, MotorDrive};

use super::motor::Motor;
use crate::file::sections;
use crate::schedule::STEP_S;

/// The [`Motor`] sets the finger speed: `v = v_max (duty - F / F_max)`, so the fingers stall at `duty F_max`. A
/// load never opens the hand. A drive reaches the fingers one dead time later. A position-controlled gripper moves by whole steps,
/// each as fast as it can. At the ends of its range and while the gear is jammed the motor is blocked.
#[derive(Clone, Debug)]
pub struct Gripper {
    parameters: sections::Gripper,
    pub motor: Motor,
    pipeline: VecDeque<MotorDrive>,
    aim_mm: f64,
    /// Distance between the pads when nothing is compressed, mm.
    pub(crate) opening_mm: f64,
    pub(crate) speed_mm_s: f64,
    /// Current over the stall current at the whole supply, as the bridge shows it, driven and short-circuited (DRV8874, section 7.3.3).
    pub(crate) current_part: f64,
    pub(crate) is_jammed: bool,
}

impl Gripper {
    pub(crate) fn new(parameters: &sections::Gripper) -> Self {
        let dead_steps = (parameters.dead_time_ms.get() / 1e3 / STEP_S).round() as usize;
        Self {
            parameters: parameters.clone(),
            motor: Motor::default(),
            pipeline: vec![MotorDrive::Coast; dead_steps].into(),
            aim_mm: parameters.opening_mm.get_ref().get(),
            opening_mm: parameters.opening_mm.get_ref().get(),
            speed_mm_s: 0.0,
            current_part: 0.0,
            is_jammed: false,
        }
    }

    pub fn step(&mut self, drive: MotorDrive, grip_n: f64) {
        self.pipeline.push_back(drive);
        let load = grip_n / self.parameters.force_n.get();
        let range_mm = self.parameters.range_mm.get();
        let (way, duty, carried, is_at_end) = match self.pipeline.pop_front().unwrap_or(drive) {
            MotorDrive::Coast => (0.0, Duty::default(), 0.0, false),
            MotorDrive::Close(duty) => (-1.0, duty, load, self.aim_mm <= 0.0),
            // The load pushes the fingers the way they go; it takes nothing from their speed and adds nothing.
            MotorDrive::Open(duty) => (1.0, duty, 0.0, self.aim_mm >= range_mm),
        };
        let duty = part(duty);
        let speed = if self.is_jammed || is_at_end { 0.0 } else { self.motor.speed(duty, carried) };
        self.current_part = self.motor.current(duty, speed);
        let before_mm = self.opening_mm;
        let moved_mm = way * speed * self.parameters.speed_mm_s.get() * STEP_S;
        self.aim_mm = (self.aim_mm + moved_mm).clamp(0.0, range_mm);
        self.opening_mm = self.reach(load);
        self.speed_mm_s = (self.opening_mm - before_mm) / STEP_S;
    }

    /// Drive for the next frame with which each finger comes to press with `target_n` and no more, once the drives before it have
    /// reached the fingers. None if it will press so hard anyway.
    pub fn closing_to(
        &self,
        target_n: f64,
        grip_n: f64,
        (width_mm, stiffness_n_per_mm): (f64, f64),
    ) -> Option<MotorDrive> {
        let load = grip_n / self.parameters.force_n.get();
        let comes_mm: f64 = self
            .pipeline
            .iter()
            .map(|drive| match drive {
                MotorDrive::Coast => 0.0,
                MotorDrive::Close(duty) => self.motor.speed(part(*duty), load),
                MotorDrive::Open(duty) => -part(*duty),
            })
            .sum::<f64>()
            * self.parameters.speed_mm_s.get()
            * STEP_S;
        let aim_mm = self.aim_mm - comes_mm;
        let opening_mm = if self.parameters.step_mm.get() > 0.0 {
            // The whole step that it stands on: it needs to aim half a step further for the next one.
            (aim_mm / self.parameters.step_mm.get()).round() * self.parameters.step_mm.get()
        } else {
            aim_mm
        };
        let missing_mm = 2.0 * target_n / stiffness_n_per_mm - (width_mm - opening_mm);
        if missing_mm <= 0.0 {
            return None;
        }
        let frame_mm = self.parameters.speed_mm_s.get() * STEP_S * SCANS_PER_FRAME as f64;
        let permille = (1e3 * (load + missing_mm / frame_mm)).ceil().min(1e3);
        Some(MotorDrive::Close(Duty::per_mille(permille as u16)))
    }

    fn reach(&self, load: f64) -> f64 {
        if self.parameters.step_mm.get() == 0.0 {
            return self.aim_mm;
        }
        if self.is_jammed {
            return self.opening_mm;
        }
        let goal_mm = ((self.aim_mm / self.parameters.step_mm.get()).round() * self.parameters.step_mm.get())
            .clamp(0.0, self.parameters.range_mm.get());
        let closing_mm = (1.0 - load).max(0.0) * self.parameters.speed_mm_s.get() * STEP_S;
        goal_mm
            .clamp(self.opening_mm - closing_mm, self.opening_mm + self.parameters.speed_mm_s.get() * STEP_S)
    }

    pub fn opening_part(&self) -> f64 {
        self.opening_mm / self.parameters.range_mm.get()
    }

    pub fn speed_part(&self) -> f64 {
        (self.speed_mm_s / self.parameters.speed_mm_s.get()).abs()
    }

    pub fn grip_n(&self, width_mm: f64, stiffness_n_per_mm: f64) -> f64 {
        (stiffness_n_per_mm * (width_mm - self.opening_mm) / 2.0).max(0.0)
    }
}

fn part(duty: Duty) -> f64 {
    f64::from(duty.as_per_mille()) / 1e3
}

#[cfg(test)]
mod tests {
    use super::super::motor::Decay;
    use super::*;
    use crate::file::quantity::Play;

    const WIDTH_MM: f64 = 70.0;
    const STIFFNESS_N_PER_MM: f64 = 3.0;

    fn hand() -> sections::Gripper {
        crate::file::plain("", "").gripper
    }

    fn run(gripper: &mut Gripper, drive: MotorDrive, for_s: f64) {
        for _ in 0..(for_s / STEP_S).round() as u32 {
            let grip_n = gripper.grip_n(WIDTH_MM, STIFFNESS_N_PER_MM);
            gripper.step(drive, grip_n);
        }
    }

    #[test]
    fn it_moves_one_dead_time_late_at_both_ends() {
        let mut gripper = Gripper::new(&hand());
        let open_mm = gripper.opening_mm;
        run(&mut gripper, MotorDrive::Close(Duty::per_mille(500)), 0.030);
        assert_eq!(gripper.opening_mm, open_mm);
        run(&mut gripper, MotorDrive::Coast, 0.030);
        assert!((open_mm - gripper.opening_mm - 0.030 * 60.0).abs() < 0.01);
        run(&mut gripper, MotorDrive::Coast, 0.1);
        assert!((open_mm - gripper.opening_mm - 0.030 * 60.0).abs() < 0.01);
    }

    #[test]
    fn it_stalls_at_its_part_of_140_n_and_a_load_never_opens_it() {
        let mut gripper = Gripper::new(&hand());
        run(&mut gripper, MotorDrive::Close(Duty::per_mille(500)), 20.0);
        run(&mut gripper, MotorDrive::Coast, 0.1);
        let grip_n = gripper.grip_n(WIDTH_MM, STIFFNESS_N_PER_MM);
        assert!((grip_n - 70.0).abs() < 0.5, "{grip_n} N");
        run(&mut gripper, MotorDrive::Coast, 10.0);
        assert_eq!(gripper.grip_n(WIDTH_MM, STIFFNESS_N_PER_MM), grip_n);
        run(&mut gripper, MotorDrive::Close(Duty::per_mille(100)), 1.0);
        assert_eq!(gripper.grip_n(WIDTH_MM, STIFFNESS_N_PER_MM), grip_n);
    }

    #[test]
    fn a_bridge_that_coasts_between_pulses_closes_no_further_on_what_it_holds() {
        let pressed_n = |decay| {
            let mut gripper = Gripper::new(&hand());
            run(&mut gripper, MotorDrive::Close(Duty::per_mille(200)), 20.0);
            gripper.motor.decay = decay;
            run(&mut gripper, MotorDrive::Close(Duty::per_mille(300)), 10.0);
            gripper.grip_n(WIDTH_MM, STIFFNESS_N_PER_MM)
        };
        assert!((pressed_n(Decay::Slow) - 42.0).abs() < 0.5);
        assert!((pressed_n(Decay::Fast) - 28.0).abs() < 0.5);
    }

    #[test]
    fn a_blocked_motor_moves_nothing_and_draws_its_duty() {
        let blocked = |gripper: &mut Gripper, drive, part: f64| {
            run(gripper, drive, 0.1);
            let opening_mm = gripper.opening_mm;
            run(gripper, drive, 0.1);
            assert_eq!(gripper.opening_mm, opening_mm, "{drive:?}");
            assert!((gripper.current_part - part).abs() < 1e-9, "{drive:?}");
        };
        let half = Duty::per_mille(500);
        for step_mm in [0.0, 0.5] {
            let mut gripper = Gripper::new(&sections::Gripper { step_mm: Play::of(step_mm), ..hand() });
            run(&mut gripper, MotorDrive::Open(Duty::FULL), 0.05);
            assert_eq!(gripper.current_part, 0.0, "the control: it moves");
            gripper.is_jammed = true;
            blocked(&mut gripper, MotorDrive::Open(half), 0.5);
            blocked(&mut gripper, MotorDrive::Close(Duty::FULL), 1.0);
            gripper.is_jammed = false;
            run(&mut gripper, MotorDrive::Open(Duty::FULL), 1.0);
            assert_eq!(gripper.opening_part(), 1.0);
            blocked(&mut gripper, MotorDrive::Open(half), 0.5);
        }
    }
}
