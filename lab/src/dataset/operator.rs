//! The person who holds the gripper while data is collected: closes it, tightens it some time after the box slips, and sometimes for no
//! reason. They see the world, never the array: what they do must not depend on any detector.

use std::collections::VecDeque;

use rand::{RngExt, rngs::ChaCha8Rng};
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_scene::World;
use tenax_scene::physics::GRAVITY_M_S2;

use super::session::Session;
use super::story::Story;

const LET_GO: MotorDrive = MotorDrive::Open(Duty::per_mille(500));
const EASE: MotorDrive = MotorDrive::Open(Duty::per_mille(40));
/// Force at which a finger stalls under the whole supply, N, and its speed without a load, mm/s: as in the three scenes.
const STALL_N: f64 = 80.0;
const SPEED_MM_S: f64 = 60.0;
/// Rate of tightening a grip, N/s, and the factor for taking hold.
const TIGHTENS_N_S: std::ops::Range<f64> = 2.0..10.0;
const TAKES_HOLD: f64 = 4.0;
/// Once it has slid so far they let it slide no more, mm: the pads are 55 mm long.
const ALARMED_MM: f64 = 25.0;
/// By now they have taken hold, s.
const TAKEN_S: f64 = 1.9;
/// Duty of closing before contact, per mille.
const COMES: f64 = 600.0;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Wish {
    Hold,
    /// Close until each finger presses so hard, N, and nothing slips.
    Tighten(f64),
    /// Open until it presses no harder, N.
    Ease(f64),
    Open,
}

/// Something that they do at an instant, s, whatever happens.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Plan {
    /// The first grip, as a part of what holds the box.
    Grip(f64),
    /// The grip times this.
    Change(f64),
    Open,
}

#[derive(Debug)]
pub struct Operator {
    rng: ChaCha8Rng,
    plans: VecDeque<(f64, Plan)>,
    mu_d: f64,
    wish: Wish,
    tightens_n_s: f64,
    stiffness_n_per_mm: f64,
    /// Slip that they tolerate, mm and s.
    patience: (f64, f64),
    slipped: (f64, f64),
    /// Total way of the object, mm.
    lost_mm: f64,
}

impl Operator {
    pub fn new(story: Story, session: &Session, mut rng: ChaCha8Rng) -> Self {
        let mut between = |low: f64, high: f64| rng.random_range(low..high);
        let plans = match story {
            Story::Pour => vec![(0.4, Plan::Grip(between(1.1, 1.7)))],
            // As often too loosely as firmly: then it slips while it is lifted.
            Story::Pick => vec![(0.4, Plan::Grip(between(0.6, 1.5))), (7.4, Plan::Open)],
            Story::Disturb => vec![
                (0.4, Plan::Grip(between(3.0, 5.0))),
                (10.2, Plan::Change(between(1.1, 1.5))),
                (11.2, Plan::Change(between(0.75, 0.95))),
                (12.2, Plan::Change(between(1.05, 1.3))),
            ],
        };
        let tightens_n_s = between(TIGHTENS_N_S.start, TIGHTENS_N_S.end);
        let mut operator = Self {
            rng,
            plans: plans.into(),
            mu_d: session.mu_d,
            wish: Wish::Hold,
            tightens_n_s,
            stiffness_n_per_mm: session.stiffness_n_per_mm,
            patience: (0.0, 0.0),
            slipped: (0.0, 0.0),
            lost_mm: 0.0,
        };
        operator.wait();
        operator
    }

    fn wait(&mut self) {
        self.patience = (self.rng.random_range(1.0..9.0), self.rng.random_range(0.3..2.5));
        self.slipped = (0.0, 0.0);
    }

    pub fn drive(&mut self, world: &World, slips: bool) -> MotorDrive {
        let (touch, t_s) = (world.touch(), world.now_s());
        let grip_n = touch.normal_n;
        let seen = world.truth().trace.last();
        let (mass_kg, needed_n) = seen.map_or((0.0, 0.0), |row| (row.mass_kg, row.needed_n));
        if let Some((_, plan)) = self.plans.pop_front_if(|(at_s, _)| t_s >= *at_s) {
            self.wish = match plan {
                // Two fingers, and no torsion.
                Plan::Grip(part) => Wish::Tighten(part * mass_kg * GRAVITY_M_S2 / 2.0 / self.mu_d),
                Plan::Change(by) if by > 1.0 => Wish::Tighten(grip_n * by),
                Plan::Change(by) => Wish::Ease(grip_n * by),
                Plan::Open => Wish::Open,
            };
        }
        if slips && self.wish == Wish::Hold {
            let frame_s = 1.0 / f64::from(FRAME_HZ);
            self.slipped.0 += touch.rub_m_s() * 1e3 * frame_s;
            self.slipped.1 += frame_s;
            self.lost_mm += touch.slide_m_s.abs() * 1e3 * frame_s;
            let alarmed = self.lost_mm > ALARMED_MM;
            if alarmed || self.slipped.0 > self.patience.0 || self.slipped.1 > self.patience.1 {
                let firmly = if alarmed { 1.5 } else { self.rng.random_range(1.0..1.12) };
                self.wish = Wish::Tighten(needed_n.max(grip_n) * firmly);
                self.wait();
            }
        }
        match self.wish {
            Wish::Hold => MotorDrive::Coast,
            Wish::Open => LET_GO,
            Wish::Ease(to_n) if grip_n > to_n => EASE,
            Wish::Tighten(to_n) if grip_n < to_n || slips => {
                let faster = if world.now_s() < TAKEN_S { TAKES_HOLD } else { 1.0 };
                // Both fingers close, against what they press on.
                let mm_s = 2.0 * faster * self.tightens_n_s / self.stiffness_n_per_mm;
                let permille = 1e3 * (mm_s / SPEED_MM_S + grip_n / STALL_N);
                MotorDrive::Close(Duty::per_mille(if grip_n > 0.0 { permille } else { COMES } as u16))
            }
            Wish::Ease(_) | Wish::Tighten(_) => {
                self.wish = Wish::Hold;
                MotorDrive::Coast
            }
        }
    }
}
