//! Everything that moves.

pub mod brush;
pub mod contact;
pub mod friction;
pub(crate) mod grasp;
pub(crate) mod gripper;
pub(crate) mod hand;
pub mod level;
pub(crate) mod limit;
pub mod motor;
pub(crate) mod pitch;
pub(crate) mod pull;
pub mod stribeck;
pub(crate) mod stroke;
pub(crate) mod vibrator;
pub(crate) mod wearer;

/// Standard gravity, m/s^2.
pub const GRAVITY_M_S2: f64 = 9.80665;

pub const TOUCH_N: f64 = 0.05;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Touch {
    pub normal_n: f64,
    /// Shear on the pad, N, positive where the object pulls the fingertip down (or along the stroke).
    pub shear_n: f64,
    pub slide_m_s: f64,
    pub turn_m_s: f64,
    pub torque_nm: f64,
    pub sticks: bool,
    pub stuck_part: f64,
    pub let_go: usize,
    pub released_n: f64,
    pub drop_n: f64,
}

impl Touch {
    pub fn rub_m_s(&self) -> f64 {
        (self.slide_m_s * self.slide_m_s + self.turn_m_s * self.turn_m_s).sqrt()
    }
}
