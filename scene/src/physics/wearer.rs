//! The wearer: what their two forearm muscles want, over the line of the scene.

use crate::file::sections::{Intent, Muscle};
use crate::plant::Calibrated;
use crate::schedule::Span;

/// The wearer of every scene, as a calibration would have found them: at rest the myosensors' default tone, two firm
/// contractions, of which the other electrode hears 5 %. Closing begins at 160 mV, and is as fast as the scenes' contractions
/// say. Opening at once takes a fifth more than is calibrated, so clear contractions of 900 mV do it, and 600 mV of mains do
/// not.
const WEARER: Calibrated = Calibrated::Levels { rest_mv: [50, 50], close_mv: [900, 95], open_mv: [80, 560] };

/// A person who contracts as the scene says, and lets go early once the hand grips as they wanted: they watch it.
#[derive(Clone, Debug)]
pub struct Wearer {
    contractions: Vec<Contraction>,
}

#[derive(Clone, Debug)]
struct Contraction {
    span: Span,
    intent: Intent,
    level_mv: f64,
    until_grip_n: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effort {
    pub intent: Option<Intent>,
    pub flexor_mv: f64,
    pub extensor_mv: f64,
}

impl Wearer {
    pub(crate) fn new(muscles: &[Muscle]) -> Self {
        let contractions = muscles.iter().map(|muscle| Contraction {
            span: Span::of(muscle.at_s, muscle.for_s),
            intent: muscle.intent,
            level_mv: muscle.level_mv.get(),
            until_grip_n: muscle.until_grip_n.map_or(f64::INFINITY, |newtons| newtons.get()),
        });
        Self { contractions: contractions.collect() }
    }

    pub(crate) fn contract(&mut self, at_s: f64, for_s: f64, intent: Intent, until_grip_n: f64) {
        // Enough for a hand that is not calibrated.
        let level_mv = if intent == Intent::Close { 900.0 } else { 2_000.0 };
        let span = Span::new(at_s, for_s);
        self.contractions.push(Contraction { span, intent, level_mv, until_grip_n });
    }

    /// To whom the hand was calibrated; None in scenes without contractions.
    pub fn calibrated(&self) -> Option<Calibrated> {
        (!self.contractions.is_empty()).then_some(WEARER)
    }

    pub fn step(&mut self, t_s: f64, grip_n: f64) -> Effort {
        let Some(now) = self.contractions.iter_mut().find(|contraction| contraction.span.contains(t_s))
        else {
            return Effort::default();
        };
        if grip_n >= now.until_grip_n {
            now.span.end_s = t_s;
            return Effort::default();
        }
        let (flexor, extensor) = match now.intent {
            Intent::Close => (1.0, 0.0),
            Intent::Open => (0.0, 1.0),
            Intent::Both => (1.0, 1.0),
        };
        Effort {
            intent: Some(now.intent),
            flexor_mv: flexor * now.level_mv,
            extensor_mv: extensor * now.level_mv,
        }
    }
}
