//! Readings of the fingertip's state.

use tenax_hal_shim::channel::PVDF_COUNT;
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::motor::Duty;
use tenax_hal_shim::wire::{Event, Forces, NetworkState, Slow, TickRecord};
use tenax_hal_shim::words::GripMode;

use super::Fingertip;
use crate::config::Config;
use crate::feedback::Felt;
use crate::grip::Grip;
use crate::hebbian::Learned;
use crate::vibration::Q;

impl Fingertip {
    pub const fn config(&self) -> &Config {
        &self.config
    }

    pub fn take_slow(&mut self) -> Option<Slow> {
        self.slow.take()
    }

    pub const fn has_slow(&self) -> bool {
        self.slow.is_some()
    }

    pub fn has_event(&self) -> bool {
        self.journal.has_event()
    }

    pub fn next_event(&mut self) -> Option<Event> {
        self.journal.next_event()
    }

    pub const fn frame(&self) -> u32 {
        self.journal.frame()
    }

    pub fn last_tick(&self) -> Option<TickRecord> {
        self.journal.last_tick()
    }

    /// Vibration envelopes, samples (14 bits).
    pub fn films(&self) -> [u16; PVDF_COUNT] {
        self.senses.envelopes().map(|envelope| u16::try_from(envelope >> Q).unwrap_or(u16::MAX))
    }

    pub const fn slip(&self) -> DetectorSet {
        self.detectors.slip()
    }

    pub const fn incipient(&self) -> DetectorSet {
        self.detectors.incipient()
    }

    #[inline(never)]
    pub fn feedback(&mut self) -> Duty {
        let load_mn = if let Grip::Holds(mn) = self.senses.grip { Some(mn) } else { None };
        let (unloaded, lost) = (self.senses.unloaded, self.journal.take_lost());
        self.feedback.step(self.config.feedback, &Felt { mode: self.mode, load_mn, unloaded, lost })
    }

    pub const fn mode(&self) -> GripMode {
        self.mode
    }

    pub const fn wearer_active(&self) -> bool {
        self.senses.gate.is_active()
    }

    /// A muscle with a healthy myosensor is active, or the button opens the hand. A lost myosensor counts as active, but renews nothing.
    pub fn wearer_renews(&self) -> bool {
        let gate = &self.senses.gate;
        gate.is_active() && (gate.is_known() || gate.is_releasing() || self.senses.muscles().is_heard())
    }

    pub fn learned(&self) -> Learned {
        self.detectors.hebbian.learned()
    }

    pub fn network(&self) -> NetworkState {
        self.detectors.hebbian.state(self.journal.frame())
    }

    pub const fn forces(&self) -> Option<Forces> {
        self.senses.forces
    }

    pub fn s2_permille(&self) -> u16 {
        self.detectors.s2.s2_permille(&self.config.friction)
    }
}
