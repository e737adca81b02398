//! The exact log of a world, which a report compares the fingertip with. None of it reaches a pin.

use crate::physics::{TOUCH_N, Touch};
use crate::schedule::STEP_S;
use crate::sensor::camera::Seen;

pub const TRACE_HZ: u32 = 200;
pub const MICRO_PAUSE_S: f64 = 0.050;

const LEFT_MM: f64 = 40.0;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Truth {
    pub slips: Vec<Slip>,
    pub micro_runs: Vec<MicroRun>,
    pub slip_distance_mm: f64,
    pub dropped: bool,
    pub left_behind: bool,
    pub handed_over: bool,
    pub turned_rad: f64,
    pub micro_slips: u64,
    pub crushed_at_s: Option<f64>,
    pub dent_mm: f64,
    pub broken_at_s: Option<f64>,
    pub pitch_rad: f64,
    pub peak_grip_n: f64,
    pub carried_ns: f64,
    pub carried_s: f64,
    pub beyond_need_ns: f64,
    pub needed_grip_n: f64,
    /// The least margin while the hand carried the object, and the last, N: the shear that a finger could still carry.
    pub margin_n: Option<[f64; 2]>,
    pub trace: Vec<Row>,
    pub camera: Vec<Seen>,
    let_go: bool,
    slide: Option<Slide>,
    micro: Option<MicroRun>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slip {
    pub micro_onset_s: f64,
    pub macro_onset_s: f64,
    pub end_s: Option<f64>,
    pub distance_mm: f64,
    pub meant: bool,
}

/// Micro slips with no pause longer than [`MICRO_PAUSE_S`] between two of them, which led to no slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MicroRun {
    pub begin_s: f64,
    pub end_s: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    pub t_s: f64,
    pub grip_n: f64,
    pub shear_n: f64,
    pub mass_kg: f64,
    pub position_mm: f64,
    pub slide_mm_s: f64,
    pub stuck_part: f64,
    /// The least grip force of each finger that would hold at this instant, N; 0 while the hand does not carry.
    pub needed_n: f64,
    pub margin_n: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Slide {
    micro_s: f64,
    begin_s: f64,
    way_mm: f64,
    counts: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Step<'a> {
    pub(crate) t_s: f64,
    pub(crate) touch: &'a Touch,
    pub(crate) state: State,
    pub(crate) floor_mm_s: f64,
    pub(crate) opens: bool,
    pub(crate) trace: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct State {
    pub(crate) carried: bool,
    pub(crate) dropped: bool,
    pub(crate) needed_n: f64,
    pub(crate) margin_n: f64,
    pub(crate) mass_kg: f64,
    pub(crate) position_mm: f64,
    pub(crate) hand_mm: f64,
    pub(crate) pitch_rad: f64,
    pub(crate) dent_mm: f64,
    pub(crate) broken: bool,
    pub(crate) shared: bool,
    pub(crate) taken: bool,
}

impl Truth {
    pub(crate) fn step(&mut self, step: &Step<'_>) {
        self.slip(step);
        let (touch, state) = (step.touch, &step.state);
        self.dropped |= state.dropped;
        self.handed_over |= state.taken;
        self.turned_rad = state.pitch_rad;
        self.let_go = step.opens || (self.let_go && touch.normal_n <= TOUCH_N);
        let apart_mm = state.hand_mm - state.position_mm;
        self.left_behind |= apart_mm > LEFT_MM && state.hand_mm > LEFT_MM && !self.let_go && !state.dropped;
        self.dent_mm = state.dent_mm;
        if state.dent_mm > 0.0 {
            self.crushed_at_s.get_or_insert(step.t_s);
        }
        if state.broken {
            self.broken_at_s.get_or_insert(step.t_s);
        }
        self.pitch_rad = self.pitch_rad.max(state.pitch_rad.abs());
        self.peak_grip_n = self.peak_grip_n.max(touch.normal_n);
        self.needed_grip_n = self.needed_grip_n.max(state.needed_n);
        if state.needed_n > 0.0 {
            self.carried_ns += touch.normal_n * STEP_S;
            self.carried_s += STEP_S;
            self.beyond_need_ns += (touch.normal_n - state.needed_n).max(0.0) * STEP_S;
            let least_n =
                self.margin_n.map_or(state.margin_n, |[least_n, _]: [f64; 2]| least_n.min(state.margin_n));
            self.margin_n = Some([least_n, state.margin_n]);
        }
        if step.trace {
            self.trace.push(Row {
                t_s: step.t_s,
                grip_n: touch.normal_n,
                shear_n: touch.shear_n,
                mass_kg: state.mass_kg,
                position_mm: state.position_mm,
                slide_mm_s: touch.slide_m_s * 1e3,
                stuck_part: touch.stuck_part,
                needed_n: state.needed_n,
                margin_n: state.margin_n,
            });
        }
    }

    pub(crate) fn slipping(&self, touch: &Touch, floor_mm_s: f64) -> bool {
        self.slide.is_some() && touch.rub_m_s() * 1e3 > floor_mm_s
    }

    /// A slip begins when the contact lets go, and counts once it is faster than the floor: what settles more slowly
    /// is no slip, and what slides while the table carries the object is none either.
    fn slip(&mut self, step: &Step<'_>) {
        let touch = step.touch;
        let slides = !touch.sticks && touch.normal_n > TOUCH_N;
        self.micro(step);
        let micro_s = self.micro.map_or(step.t_s, |run| run.begin_s);
        let Some(mut slide) = self.slide.or_else(|| {
            (slides && step.state.carried).then_some(Slide {
                micro_s,
                begin_s: step.t_s,
                way_mm: 0.0,
                counts: false,
            })
        }) else {
            return;
        };
        let way_mm = touch.slide_m_s.abs() * 1e3 * STEP_S;
        slide.way_mm += way_mm;
        if !slide.counts && touch.rub_m_s() * 1e3 > step.floor_mm_s {
            slide.counts = true;
            self.slips.push(Slip {
                micro_onset_s: slide.micro_s,
                macro_onset_s: slide.begin_s,
                end_s: None,
                distance_mm: 0.0,
                meant: step.opens || step.state.shared,
            });
        }
        if slide.counts
            && let Some(slip) = self.slips.last_mut()
        {
            if !slip.meant {
                self.slip_distance_mm += slide.way_mm - slip.distance_mm;
            }
            slip.distance_mm = slide.way_mm;
            slip.end_s = (!slides).then_some(step.t_s);
        }
        self.slide = slides.then_some(slide);
        if !slides {
            if !slide.counts && step.touch.normal_n > TOUCH_N {
                self.micro_runs.push(MicroRun { begin_s: slide.micro_s, end_s: step.t_s });
            }
            // Everything sticks again: what lets go from now on leads to another slip.
            self.micro = None;
        }
    }

    fn micro(&mut self, step: &Step<'_>) {
        let t_s = step.t_s;
        if let Some(run) = self.micro.take_if(|run| t_s - run.end_s > MICRO_PAUSE_S)
            && self.slide.is_none()
        {
            self.micro_runs.push(run);
        }
        if step.touch.let_go > 0 && step.touch.normal_n > TOUCH_N {
            self.micro_slips += step.touch.let_go as u64;
            self.micro.get_or_insert(MicroRun { begin_s: t_s, end_s: t_s }).end_s = t_s;
        }
    }
}
