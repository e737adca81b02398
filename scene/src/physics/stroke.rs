//! A probe stroked over a surface by a robot's arm (Prosthesis, figures 3 to 7).

use super::friction::Surface;
use super::level::{Level, Push};
use super::{TOUCH_N, Touch};
use crate::file::SceneFile;
use crate::file::sections::Robot;
use crate::schedule::{STEP_S, Span, smooth};

/// The fingertip on a carriage: pressed with a set load, pulled along through the arm's compliance.
///
/// `m v' = k (x_carriage - x) + c (v_carriage - v) - friction`. The arm is the spring that makes Ft/Fn climb to mu_s
/// before anything slides, as in figure 7a.
#[derive(Clone, Debug)]
pub struct Stroke {
    presses: Vec<(Span, f64)>,
    ramp_s: f64,
    sweeps: Vec<(Span, f64)>,
    mass_kg: f64,
    stiffness_n_per_m: f64,
    damping_ns_per_m: f64,
    surface: Surface,
    contact: Level,
    carriage_m: f64,
    pub(crate) probe_m: f64,
    speed_m_s: f64,
}

impl Stroke {
    pub(crate) fn new(scene: &SceneFile, robot: &Robot) -> Self {
        let mass_kg = robot.probe_kg.get();
        let stiffness_n_per_m = robot.stiffness_n_per_mm.get() * 1e3;
        Self {
            presses: scene
                .press
                .iter()
                .map(|press| (Span::of(press.at_s, press.for_s), press.load_n.get()))
                .collect(),
            ramp_s: robot.ramp_ms.get() / 1e3,
            sweeps: scene
                .sweep
                .iter()
                .map(|sweep| (Span::of(sweep.at_s, sweep.for_s), sweep.speed_mm_s.get() / 1e3))
                .collect(),
            mass_kg,
            stiffness_n_per_m,
            damping_ns_per_m: 2.0 * robot.damping.get() * (stiffness_n_per_m * mass_kg).sqrt(),
            surface: Surface::new(&scene.contact, &scene.wet),
            contact: Level::new(&scene.contact),
            carriage_m: 0.0,
            probe_m: 0.0,
            speed_m_s: 0.0,
        }
    }

    pub fn step(&mut self, t_s: f64) -> Touch {
        let load_n = self.over_time(&self.presses, t_s);
        let friction = self.surface.at(t_s);
        let carriage_m_s = self.over_time(&self.sweeps, t_s);
        self.carriage_m += carriage_m_s * STEP_S;
        let pull_n = self.stiffness_n_per_m * (self.carriage_m - self.probe_m)
            + self.damping_ns_per_m * (carriage_m_s - self.speed_m_s);
        let free_m_s = self.speed_m_s + pull_n / self.mass_kg * STEP_S;
        let push = Push { normal_n: load_n, pads: 1.0, friction, mass_kg: self.mass_kg, free_m_s };
        let outcome = self.contact.step(push, STEP_S);
        self.speed_m_s = outcome.speed_m_s;
        self.probe_m += self.speed_m_s * STEP_S;
        let drop_n = (friction.mu_s - friction.mu_d) * load_n;
        Touch {
            normal_n: load_n,
            shear_n: -outcome.force_n,
            slide_m_s: self.speed_m_s,
            sticks: outcome.sticks,
            stuck_part: outcome.stuck_part,
            let_go: outcome.let_go,
            released_n: if load_n > TOUCH_N { outcome.released_n } else { 0.0 },
            drop_n,
            ..Touch::default()
        }
    }

    fn over_time(&self, list: &[(Span, f64)], t_s: f64) -> f64 {
        let part = |span: &Span| {
            let up = ((t_s - span.begin_s) / self.ramp_s).clamp(0.0, 1.0);
            let down = ((span.end_s - t_s) / self.ramp_s).clamp(0.0, 1.0);
            smooth(up.min(down))
        };
        list.iter().map(|(span, height)| height * part(span)).sum()
    }
}
