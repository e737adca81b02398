//! Sensors that break, when and how the scene says.

use tenax_hal_shim::channel::{
    CHANNELS, COUNT, FSR, FSR_COUNT, Input, PVDF, PVDF_COUNT, REFERENCE_MV, SWITCH_INPUTS,
};
use tenax_hal_shim::front_end::PVDF_CUT_MV;

use crate::file::sections::{FaultKind, SensorFault};
use crate::schedule::Span;

const CUT_S: f64 = 0.105;
const FILM_CUT_S: f64 = 0.010;

fn shown_before(channel: usize) -> Option<usize> {
    let before = |select: u8| (select + SWITCH_INPUTS - 1) % SWITCH_INPUTS;
    let input = match CHANNELS[channel].input {
        Input::Direct { .. } => return None,
        Input::SwitchA { select } => Input::SwitchA { select: before(select) },
        Input::SwitchB { select } => Input::SwitchB { select: before(select) },
    };
    CHANNELS.iter().position(|channel| channel.input == input)
}

#[derive(Clone, Debug)]
pub(crate) struct Faults(Vec<Fault>);

#[derive(Clone, Debug)]
struct Fault {
    span: Span,
    channel: usize,
    kind: FaultKind,
    with: usize,
    press_n: f64,
    drift_per_s: f64,
    stuck_v: Option<f64>,
}

impl Faults {
    pub(crate) fn new(faults: &[SensorFault]) -> Self {
        let faults = faults.iter().map(|fault| {
            let begin_s = fault.at_s.get();
            let end_s = fault.until_s.as_ref().map_or(f64::INFINITY, |until| until.get());
            Fault {
                span: Span { begin_s, end_s },
                channel: fault.channel.get_ref().index(),
                kind: fault.kind,
                with: fault.with.as_ref().unwrap_or(&fault.channel).get_ref().index(),
                press_n: fault.press_n.as_ref().map_or(0.0, |press| press.get_ref().get()),
                drift_per_s: fault.drift_per_s.as_ref().map_or(0.0, |drift| drift.get_ref().get()),
                stuck_v: None,
            }
        });
        Self(faults.collect())
    }

    /// Cuts the wire of the first film that has one.
    pub(crate) fn cut_film(&mut self, at_s: f64) {
        let is_cut = |channel: usize| self.0.iter().any(|own| own.channel == channel && own.is_cut_film());
        let Some(channel) = (PVDF..PVDF + PVDF_COUNT).find(|&channel| !is_cut(channel)) else { return };
        let span = Span { begin_s: at_s, end_s: f64::INFINITY };
        let kind = FaultKind::Cut;
        self.0.push(Fault {
            span,
            channel,
            kind,
            with: channel,
            press_n: 0.0,
            drift_per_s: 0.0,
            stuck_v: None,
        });
    }

    pub(crate) fn pressed_n(&self, t_s: f64) -> [f64; FSR_COUNT] {
        let mut pressed_n = [0.0; FSR_COUNT];
        for fault in self.0.iter().filter(|fault| fault.span.contains(t_s)) {
            match fault.kind {
                FaultKind::Pressed => pressed_n[fault.channel - FSR] += fault.press_n,
                FaultKind::Drift if (FSR..FSR + FSR_COUNT).contains(&fault.channel) => {
                    pressed_n[fault.channel - FSR] += fault.drifted(t_s);
                }
                _ => {}
            }
        }
        pressed_n
    }

    pub(crate) fn cut_films(&mut self, t_s: f64, pins_v: &mut [f64; COUNT]) {
        for fault in self.0.iter_mut().filter(|fault| fault.is_cut_film() && fault.span.contains(t_s)) {
            let pin_v = &mut pins_v[fault.channel];
            let rest_v = f64::from(PVDF_CUT_MV) / 1e3;
            let swing_v = *fault.stuck_v.get_or_insert(*pin_v) - rest_v;
            *pin_v = rest_v + swing_v * libm::exp(-(t_s - fault.span.begin_s) / FILM_CUT_S);
        }
    }

    pub(crate) fn apply(&mut self, t_s: f64, pins_v: &mut [f64; COUNT]) {
        for fault in self.0.iter_mut().filter(|fault| fault.span.contains(t_s)) {
            match fault.kind {
                FaultKind::Swapped => pins_v.swap(fault.channel, fault.with),
                FaultKind::Bridged => {
                    let both_v = (pins_v[fault.channel] + pins_v[fault.with]) / 2.0;
                    (pins_v[fault.channel], pins_v[fault.with]) = (both_v, both_v);
                }
                _ => {}
            }
            // An input that nothing is connected to, as two of switch B, is at ground.
            let before_v = shown_before(fault.channel).map_or(0.0, |before| pins_v[before]);
            let since_s = t_s - fault.span.begin_s;
            let pin_v = &mut pins_v[fault.channel];
            *pin_v = match fault.kind {
                FaultKind::Dead => 0.0,
                FaultKind::Cut if fault.is_cut_film() => *pin_v,
                FaultKind::Cut => *fault.stuck_v.get_or_insert(*pin_v) * libm::exp(-since_s / CUT_S),
                FaultKind::Open => before_v,
                FaultKind::Saturated => f64::from(REFERENCE_MV) / 1e3,
                FaultKind::Stuck => *fault.stuck_v.get_or_insert(*pin_v),
                FaultKind::Pressed | FaultKind::Swapped | FaultKind::Bridged => *pin_v,
                FaultKind::Drift if (FSR..FSR + FSR_COUNT).contains(&fault.channel) => *pin_v,
                FaultKind::Drift => *pin_v + fault.drifted(t_s) / 1e3,
            };
        }
    }
}

impl Fault {
    fn is_cut_film(&self) -> bool {
        self.kind == FaultKind::Cut && (PVDF..PVDF + PVDF_COUNT).contains(&self.channel)
    }

    fn drifted(&self, t_s: f64) -> f64 {
        (t_s - self.span.begin_s) * self.drift_per_s
    }
}
