//! What moves, and what makes it move.

pub mod brush;
pub mod contact;
pub mod friction;
pub mod grasp;
pub mod gripper;
pub mod hand;
pub mod level;
pub mod limit;
pub mod patch;
pub mod pitch;
pub(crate) mod pull;
pub mod stribeck;
pub mod stroke;
pub(crate) mod vibrator;
pub mod wearer;

/// Standard gravity, m/s^2.
pub const GRAVITY_M_S2: f64 = 9.80665;

/// A pad that is pressed with less than this touches nothing worth the name, N.
pub const TOUCH_N: f64 = 0.05;

/// What the sensed fingertip feels of the world in one step: all that the sensors are told.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Touch {
    pub normal_n: f64,
    /// Shear on the pad, N, positive where the object pulls the fingertip down (or along the stroke).
    pub shear_n: f64,
    /// Speed of the object over the pad, m/s, in the direction of the shear.
    pub slide_m_s: f64,
    /// Speed of the pad's edge over the object because the object turns, m/s.
    pub turn_m_s: f64,
    /// Torsion on the pad, N m.
    pub torque_nm: f64,
    pub sticks: bool,
    /// The part of the contact's area that sticks.
    pub stuck_part: f64,
    /// Elements of the contact that let go in this step.
    pub let_go: usize,
    /// The shear that they let go of, N: (mu_s - mu_d) times their part of the normal force. These are the micro-slip
    /// events that the PVDF hears.
    pub released_n: f64,
    /// The shear that sliding lacks of sticking, N: what the texture's vibration grows with.
    pub drop_n: f64,
}

impl Touch {
    /// How fast the object rubs over the pad, m/s: along it, and by turning.
    pub fn rub_m_s(&self) -> f64 {
        (self.slide_m_s * self.slide_m_s + self.turn_m_s * self.turn_m_s).sqrt()
    }
}
