//! What the fingertip tells of itself.

use tenax_hal_shim::channel::PVDF_COUNT;
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::motor::Duty;
use tenax_hal_shim::wire::{Event, NetworkState, Slow};
use tenax_hal_shim::words::GripMode;

use super::Fingertip;
use crate::config::Config;
use crate::feedback::Felt;
use crate::grip::Grip;
use crate::hebbian::Learned;
use crate::vibration::Q;

impl Fingertip {
    /// Every number that can be chosen, as it is in force.
    #[must_use]
    pub const fn config(&self) -> &Config {
        &self.config
    }

    /// The slow frame that the last tick ended, if it ended one.
    pub fn take_slow(&mut self) -> Option<Slow> {
        self.slow.take()
    }

    /// Whether the last tick ended a slow frame that was not taken yet.
    #[must_use]
    pub const fn has_slow(&self) -> bool {
        self.slow.is_some()
    }

    /// Whether something happened that was not taken yet.
    #[must_use]
    pub fn has_event(&self) -> bool {
        self.journal.has_event()
    }

    /// The oldest thing that happened and has not been taken yet.
    pub fn next_event(&mut self) -> Option<Event> {
        self.journal.next_event()
    }

    /// Sequence number of the last frame taken.
    #[must_use]
    pub const fn frame(&self) -> u32 {
        self.journal.frame()
    }

    /// The vibration envelope of each film, in samples.
    #[must_use]
    pub fn films(&self) -> [u16; PVDF_COUNT] {
        self.senses.envelopes().map(|envelope| u16::try_from(envelope >> Q).unwrap_or(u16::MAX))
    }

    /// The detectors that say slip, whoever listens.
    #[must_use]
    pub const fn slip(&self) -> DetectorSet {
        self.detectors.slip()
    }

    /// The detectors that warn of it. The line tells both in one.
    #[must_use]
    pub const fn incipient(&self) -> DetectorSet {
        self.detectors.incipient()
    }

    /// How to drive the vibration motor until this is asked again. Ask it once a slow frame.
    #[inline(never)]
    pub fn feedback(&mut self) -> Duty {
        let load_mn = if let Grip::Holds(mn) = self.senses.grip { Some(mn) } else { None };
        let (unloaded, lost) = (self.senses.unloaded, self.journal.take_lost());
        self.feedback.step(self.config.feedback, &Felt { mode: self.mode, load_mn, unloaded, lost })
    }

    /// What the reflex is doing.
    #[must_use]
    pub const fn mode(&self) -> GripMode {
        self.mode
    }

    /// Whether a myosensor is active, its hold time included.
    #[must_use]
    pub const fn wearer_active(&self) -> bool {
        self.senses.gate.is_active()
    }

    /// Whether somebody has taken over for sure: only then budgets of closing begin anew. A lost myosensor, active for want of one that says
    /// otherwise, is nobody.
    #[must_use]
    pub fn wearer_renews(&self) -> bool {
        let gate = &self.senses.gate;
        gate.is_active() && (gate.is_known() || gate.is_releasing() || self.senses.muscles().is_heard())
    }

    /// What the Hebbian network has learned, with the maxima that its weights belong to.
    #[must_use]
    pub fn learned(&self) -> Learned {
        self.detectors.hebbian.learned()
    }

    /// What the network knows and feels.
    #[must_use]
    pub fn network(&self) -> NetworkState {
        self.detectors.hebbian.state(self.journal.frame())
    }
}
