//! The curves of a run, drawn and thinned while it goes.

use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, REFERENCE_MV, SAMPLE_MAX};
use tenax_hal_shim::wire::{Slow, TickRecord};
use tenax_hal_shim::words::{DriveSource, GripMode};
use tenax_scene::truth::Row;

use crate::board::Recorder;
use crate::plot::thin::Thin;
use crate::timeline::{frame_end_s, ticks};

#[derive(Clone, Debug)]
pub struct Sketch {
    pub span_s: (f64, f64),
    zero_s: f64,
    /// End of the last slow frame and half a frame, s.
    pub end_s: Option<f64>,
    pub first_mode: Option<GripMode>,
    /// Fn and Ft as measured, N.
    pub forces: [Thin; 2],
    pub needs: Option<Needs>,
    pub ratio: Thin,
    /// S2. A stroke changes it.
    pub s2: Thin,
    /// The PVDF envelope, mV.
    pub vibration: Thin,
    /// Flexor and extensor, mV.
    pub muscles: [Thin; 2],
    pub motor: [Drive; 4],
}

#[derive(Clone, Debug)]
pub struct Needs {
    /// Grip force, N.
    pub grip: Thin,
    /// The least force that holds the object, N.
    pub needed: Thin,
}

/// The motor's drive, %, closing above 0, by one source.
#[derive(Clone, Debug)]
pub struct Drive {
    pub source: DriveSource,
    pub percent: Thin,
    pub drove: bool,
}

impl Sketch {
    /// Of a run that has not begun, between two instants, s; `zero_s` is added to virtual time.
    pub fn new(zero_s: f64, span_s: (f64, f64)) -> Self {
        let thin = || Thin::new(span_s);
        Self {
            span_s,
            zero_s,
            end_s: None,
            first_mode: None,
            forces: [thin(), thin()],
            needs: None,
            ratio: thin(),
            s2: thin(),
            vibration: thin(),
            muscles: [thin(), thin()],
            motor: [DriveSource::Wearer, DriveSource::Reflex, DriveSource::Link, DriveSource::Behaviour]
                .map(|source| Drive { source, percent: thin(), drove: false }),
        }
    }

    fn tick(&mut self, t_s: f64, tick: &TickRecord) {
        self.vibration.push((t_s, mv(tick.vibration)));
        for own in &mut self.motor {
            let drives = tick.source == own.source;
            own.percent
                .push((t_s, if drives { f64::from(tick.drive.signed_permille()) / 10.0 } else { 0.0 }));
            own.drove |= drives;
        }
    }
}

impl Recorder for Sketch {
    fn slow(&mut self, slow: &Slow) {
        for (frame, tick) in ticks(slow) {
            self.tick(self.zero_s + frame_end_s(frame), tick);
        }
        let t_s = self.zero_s + frame_end_s(slow.frame);
        self.first_mode.get_or_insert(slow.mode);
        // A gap where there is no number.
        let point = |value: Option<f64>| (t_s, value.unwrap_or(f64::NAN));
        let newtons = |mn: i32| f64::from(mn) / 1e3;
        let [normal, shear] = &mut self.forces;
        normal.push(point(slow.forces.map(|forces| newtons(forces.fn_mn))));
        shear.push(point(slow.forces.map(|forces| newtons(forces.ft_mn))));
        let ratio = slow.forces.and_then(|forces| forces.ratio_permille);
        self.ratio.push(point(ratio.map(per_mille)));
        self.s2.push((t_s, per_mille(slow.s2_permille)));
        let [flexor, extensor] = &mut self.muscles;
        flexor.push(point(slow.flexor_mv.map(f64::from)));
        extensor.push(point(slow.extensor_mv.map(f64::from)));
        self.end_s = Some(t_s + f64::from(FRAMES_PER_SLOW_FRAME) * 0.5e-3);
    }
}

impl Needs {
    /// Of a world that has not begun, between two instants, s.
    pub fn new(span_s: (f64, f64)) -> Self {
        Self { grip: Thin::new(span_s), needed: Thin::new(span_s) }
    }

    pub fn push(&mut self, row: &Row) {
        self.grip.push((row.t_s, row.grip_n));
        // While the hand carries nothing, nothing is needed: a gap in the curve.
        self.needed.push((row.t_s, if row.needed_n > 0.0 { row.needed_n } else { f64::NAN }));
    }
}

/// A PVDF sample as a voltage at the pin, mV.
pub(super) fn mv(sample: u16) -> f64 {
    f64::from(sample) * f64::from(REFERENCE_MV) / f64::from(SAMPLE_MAX)
}

fn per_mille(value: u16) -> f64 {
    f64::from(value) / 1e3
}
