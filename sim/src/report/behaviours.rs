//! The behaviours of a run, and how each ended.

use serde::Serialize;
use tenax_hal_shim::wire::{Event, EventKind};

use crate::timeline::Timeline;

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Ran {
    pub name: &'static str,
    pub begin_s: f64,
    /// Until when, s. Null if it still went on.
    pub end_s: Option<f64>,
    pub ending: Option<&'static str>,
}

pub fn of(events: &[Event], timeline: &Timeline) -> Vec<Ran> {
    let mut all: Vec<Ran> = Vec::new();
    for event in events {
        let EventKind::Behaviour(what, ending) = event.kind else { continue };
        let t_s = timeline.time_s(event.frame);
        match (ending, all.last_mut()) {
            (None, _) => all.push(Ran { name: what.name(), begin_s: t_s, end_s: None, ending: None }),
            (Some(ending), Some(last)) => {
                last.end_s = Some(t_s);
                last.ending = Some(ending.name());
            }
            (Some(_), None) => {}
        }
    }
    all
}
