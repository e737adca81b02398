//! Another hand that pulls at the object, and may take it over.

use crate::file::sections;
use crate::schedule::{Span, smooth};

#[derive(Clone, Debug)]
pub(crate) struct Pulls(Vec<Pull>);

#[derive(Clone, Debug)]
struct Pull {
    comes: Span,
    goes: Span,
    force_n: f64,
    takes: bool,
}

impl Pulls {
    pub(crate) fn new(pulls: &[sections::Pull]) -> Self {
        let pull = |pull: &sections::Pull| {
            let (at_s, ramp_s) = (pull.at_s.get(), pull.ramp_ms.get() / 1e3);
            Pull {
                comes: Span::new(at_s, ramp_s),
                goes: Span::new(at_s + pull.for_s.get(), ramp_s),
                force_n: pull.force_n.get(),
                takes: pull.takes,
            }
        };
        Self(pulls.iter().map(pull).collect())
    }

    pub(crate) fn push(&mut self, at_s: f64, for_s: f64, force_n: f64, ramp_s: f64) {
        let (comes, goes) = (Span::new(at_s, ramp_s), Span::new(at_s + for_s, ramp_s));
        self.0.push(Pull { comes, goes, force_n, takes: false });
    }

    pub(crate) fn force_n(&self, t_s: f64) -> f64 {
        let part = |pull: &Pull| smooth(pull.comes.progress(t_s)) - smooth(pull.goes.progress(t_s));
        self.0.iter().map(|pull| pull.force_n * part(pull)).sum()
    }

    pub(crate) fn takes(&self, t_s: f64) -> bool {
        self.0.iter().any(|pull| pull.takes && (pull.comes.begin_s..pull.goes.begin_s).contains(&t_s))
    }
}
