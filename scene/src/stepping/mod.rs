//! How friction is stepped through time, where each way of it fails, and what it costs.
//!
//! Five [`Method`]s run the same [`problem`]s. The scenes use [`Moreau`]; the others are here to be measured against it
//! (`tenax chart scenes`, read in `docs/stepping.md`), and [`bounds`](crate::bounds) says where theory puts the edge of each.

mod euler;
mod exponential;
mod implicit;
mod lugre;
mod moreau;
pub mod problem;
mod runge_kutta;

pub use euler::ExplicitEuler;
pub use exponential::Exponential;
pub use implicit::Implicit;
pub use lugre::LuGre;
pub use moreau::Moreau;
pub use runge_kutta::RungeKutta4;

use crate::physics::contact::RigidCoulomb;
use crate::physics::friction::Friction;

/// The step that the scenes use, s: one scan.
pub const SHIPPED_S: f64 = crate::schedule::STEP_S;

/// What acts on a body at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Everything but friction, N.
    pub force_n: f64,
    /// On the contact, N. Above 0: a contact that opens is the scenes' business.
    pub normal_n: f64,
    /// Speed of what it rubs on, m/s.
    pub surface_m_s: f64,
}

/// One mass that moves along one line and rubs on one surface.
pub trait Body {
    /// Its mass, kg.
    fn mass_kg(&self) -> f64;
    /// Between it and the surface.
    fn friction(&self) -> Friction;
    /// Where and how fast it begins: m, m/s.
    fn start(&self) -> (f64, f64);
    /// What acts on it at `t_s`, at `position_m`, at `speed_m_s`.
    fn load(&self, t_s: f64, position_m: f64, speed_m_s: f64) -> Load;
}

/// A body in motion. Each method uses what it needs of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Where it is, m.
    pub position_m: f64,
    /// How fast it is, m/s.
    pub speed_m_s: f64,
    /// How far it has slid over the surface, m.
    pub slid_m: f64,
    /// LuGre's z, m.
    pub bristle_m: f64,
    /// Whether Coulomb's contact sticks.
    pub contact: RigidCoulomb,
}

impl State {
    /// Where `body` begins.
    #[must_use]
    pub fn new(body: &dyn Body) -> Self {
        let (position_m, speed_m_s) = body.start();
        Self { position_m, speed_m_s, slid_m: 0.0, bristle_m: 0.0, contact: RigidCoulomb::default() }
    }
}

/// One element of a patch that is dragged at a given speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bristle {
    /// The deflection at which it slides, m: LuGre's g / sigma0.
    pub sliding_m: f64,
}

/// A way to step friction through time.
///
/// A method never looks into the future and never changes its step; it may be unstable, that is the point of the map.
pub trait Method: Send + Sync {
    /// What charts call it.
    fn name(&self) -> &'static str;
    /// Moves `state` from `t_s` on by `dt_s`.
    fn step(&self, body: &dyn Body, state: &mut State, t_s: f64, dt_s: f64);
    /// The deflection of a bristle after `dt_s` at the constant speed `slide_m_s`.
    fn drag(&self, bristle: Bristle, bristle_m: f64, slide_m_s: f64, dt_s: f64) -> f64;
}

/// All methods, the LuGre ones with the same bristle.
#[must_use]
pub fn methods(lugre: LuGre) -> [Box<dyn Method>; 5] {
    [
        Box::new(ExplicitEuler(lugre)),
        Box::new(RungeKutta4(lugre)),
        Box::new(Exponential(lugre)),
        Box::new(Implicit(lugre)),
        Box::new(Moreau),
    ]
}

/// Steps `body` for `steps` steps of `dt_s` and shows each state, with its time, to `look`; false ends it.
pub fn run(
    method: &dyn Method,
    body: &dyn Body,
    dt_s: f64,
    steps: u64,
    mut look: impl FnMut(f64, &State) -> bool,
) {
    let mut state = State::new(body);
    for n in 0..steps {
        method.step(body, &mut state, n as f64 * dt_s, dt_s);
        if !look((n + 1) as f64 * dt_s, &state) {
            break;
        }
    }
}
