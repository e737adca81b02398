//! Grips that answer the same senses in other ways. In each the wearer comes first, and none closes an empty hand or above the ceiling.

use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, frames};
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::Forces;
use tenax_logic::fingertip::Fingertip;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rival {
    /// S1 sends a close signal (Prosthesis, figure 9), always the same.
    Fixed,
    /// 7116d874: S1 and S2, a pulse ends at the force that is missing, doubles the load at most, and the object then settles.
    Sized,
    /// Duty in proportion to the deficit of margin one dead time ahead, anew with every reading.
    Lead,
}

/// Pulse against slip, its longest, and the time after it in which nothing is answered: as 7116d874 shipped them.
const PULSE: u32 = frames(30);
const LONGEST: u32 = frames(50);
const SETTLES: u32 = frames(80);
const LEAST: u32 = frames(3);
const WARNED_PERMILLE: u16 = 400;
/// Slip that is heard again so soon goes on.
const AT_ONCE: u32 = frames(30);
/// Readings in which the force does not show yet what the motor has done.
const NOT_FELT: usize = 3;

/// Deficit that is answered at full duty, and how far ahead: of 1, 4 and 12 N on 30 drawn worlds of seed 2 the largest that loses no more.
pub const BAND_MN: f64 = 4_000.0;
const AHEAD_S: f64 = 0.03;
const AIM: f64 = 1.2;

const READING_S: f64 = FRAMES_PER_SLOW_FRAME as f64 / 2_000.0;
const LEAST_RATIO: f64 = 0.07;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Mode {
    #[default]
    Watch,
    Slip,
    Warned,
    Settle,
}

#[derive(Clone, Debug)]
pub struct Grip {
    rival: Rival,
    mode: Mode,
    elapsed: u32,
    /// Pulses in a row, each as soon as the one before had settled.
    row: u32,
    began_mn: f64,
    /// Travel, per mille of duty times frames: of the pulse that is left, since the last reading, and of the readings before.
    left: Option<f64>,
    travel: f64,
    travels: [f64; 7],
    /// Force that a frame at full duty adds, mN.
    stiffness: f64,
    last: Option<Forces>,
    loads_mn: [f64; 3],
    shears_mn: [f64; 8],
    ratios: [f64; 4],
    /// Least ratio at which it has slid.
    slid: f64,
    deficit_mn: f64,
    duty: u16,
}

impl Grip {
    pub fn new(rival: Rival) -> Self {
        Self {
            rival,
            mode: Mode::Watch,
            elapsed: 0,
            row: 0,
            began_mn: 0.0,
            left: None,
            travel: 0.0,
            travels: [0.0; 7],
            stiffness: 0.0,
            last: None,
            loads_mn: [0.0; 3],
            shears_mn: [0.0; 8],
            ratios: [0.0; 4],
            slid: f64::INFINITY,
            deficit_mn: 0.0,
            duty: 0,
        }
    }

    /// The drive of the next frame, beside what the wearer's is.
    pub fn drive(&mut self, own: MotorDrive, fingertip: &Fingertip) -> MotorDrive {
        let config = fingertip.config();
        let holds = |own: &Forces| (config.friction.loaded_mn..config.grip.ceiling_mn).contains(&own.load_mn);
        let held = fingertip.forces().filter(holds);
        let slips = fingertip.slip().contains(DetectorId::S1);
        let is_new = held.is_some() && held != self.last;
        if let Some(forces) = held.filter(|_| is_new) {
            self.feel(&forces, f64::from(fingertip.s2_permille()) / 1e3, slips);
        }
        self.last = held;
        let free = own == MotorDrive::Coast && !fingertip.wearer_active() && held.is_some();
        if !free {
            (self.mode, self.row, self.slid, self.duty) = (Mode::Watch, 0, f64::INFINITY, 0);
        } else if self.rival != Rival::Lead {
            self.pulse(slips, fingertip.incipient().contains(DetectorId::S2));
        }
        let drive = match own {
            MotorDrive::Coast if free && self.duty > 0 => MotorDrive::Close(Duty::per_mille(self.duty)),
            _ => own,
        };
        if let MotorDrive::Close(duty) = drive {
            self.travel += f64::from(duty.as_per_mille());
            self.left = self.left.map(|left| left - f64::from(duty.as_per_mille()));
        }
        drive
    }

    /// Takes a reading.
    fn feel(&mut self, forces: &Forces, s2: f64, slips: bool) {
        let [load_mn, ft_mn] = [forces.load_mn, forces.ft_mn].map(f64::from);
        let oldest_mn = self.loads_mn[2];
        self.loads_mn = [load_mn, self.loads_mn[0], self.loads_mn[1]];
        for (all, new) in
            [(&mut self.travels[..], std::mem::take(&mut self.travel)), (&mut self.shears_mn, ft_mn)]
        {
            all.rotate_right(1);
            all[0] = new;
        }
        let ratio = (ft_mn / load_mn).max(LEAST_RATIO);
        self.ratios.rotate_right(1);
        self.ratios[0] = ratio;
        let most = self.travels[2..].windows(3).map(|own| own.iter().sum()).fold(0.0, f64::max);
        if oldest_mn > 0.0 && load_mn - oldest_mn > 60.0 && most >= 3_000.0 {
            self.stiffness = self.stiffness.max(1e3 * (load_mn - oldest_mn) / most);
        }
        if slips {
            self.slid = self.slid.min(ratio);
        }
        let carried_mn = self.shears_mn.iter().copied().fold(0.0, f64::max);
        let grows_mn = |mn: f64| (mn - self.shears_mn[7]).max(0.0);
        let (mn, aim, friction) = match (self.rival, self.mode) {
            (Rival::Lead, _) => (ft_mn, AIM, s2.min(0.9 * self.slid)),
            (_, Mode::Warned) => (ft_mn + grows_mn(ft_mn), 1.25, ratio.min(s2)),
            _ if self.row > 1 => {
                (carried_mn + grows_mn(carried_mn), 1.35, self.ratios.into_iter().fold(0.0, f64::max))
            }
            (_, Mode::Slip) if self.elapsed >= frames(25) => (carried_mn + grows_mn(carried_mn), 1.35, ratio),
            _ => (carried_mn + grows_mn(carried_mn), 1.62, ratio),
        };
        let deficit_mn = mn * aim / friction - load_mn;
        let ahead_mn = deficit_mn + (deficit_mn - self.deficit_mn) / READING_S * AHEAD_S;
        self.deficit_mn = deficit_mn;
        if self.rival == Rival::Lead {
            self.duty = (1e3 * ahead_mn.max(0.0) / BAND_MN).min(1e3) as u16;
        }
        self.size();
    }

    /// Travel that the missing force takes, less what the force does not show yet.
    fn size(&mut self) {
        let coming = self.travels[..NOT_FELT].iter().sum::<f64>() + self.travel;
        let known = self.rival == Rival::Sized && self.stiffness > 0.0;
        self.left = known.then(|| 1e3 * self.deficit_mn.clamp(0.0, self.began_mn) / self.stiffness - coming);
    }

    fn pulse(&mut self, slips: bool, warns: bool) {
        self.elapsed += 1;
        let is_done = |least: u32| self.elapsed >= least && self.left.is_some_and(|left| left <= 0.0);
        let next = match self.mode {
            Mode::Watch if slips => Mode::Slip,
            Mode::Watch if warns && self.rival == Rival::Sized => Mode::Warned,
            Mode::Slip if is_done(LEAST << (self.row - 1)) => Mode::Settle,
            Mode::Slip
                if self.elapsed >= if slips && self.rival == Rival::Sized { LONGEST } else { PULSE } =>
            {
                Mode::Settle
            }
            Mode::Warned if slips => Mode::Slip,
            Mode::Warned if is_done(LEAST) || self.elapsed >= LONGEST => Mode::Settle,
            Mode::Settle if self.elapsed >= SETTLES => Mode::Watch,
            mode => mode,
        };
        if next != self.mode {
            if next == Mode::Slip {
                self.row = if self.elapsed < AT_ONCE { (self.row + 1).min(5) } else { 1 };
            }
            (self.mode, self.elapsed) = (next, 0);
            self.began_mn = self.loads_mn[0];
            self.size();
        }
        self.duty = match self.mode {
            Mode::Slip => 1_000,
            Mode::Warned => WARNED_PERMILLE,
            Mode::Watch | Mode::Settle => 0,
        };
    }
}
