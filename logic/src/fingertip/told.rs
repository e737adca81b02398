//! Readings of the fingertip's state.

use tenax_hal_shim::channel::PVDF_COUNT;
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::motor::Duty;
use tenax_hal_shim::wire::{Event, Forces, NetworkState, Slow};
use tenax_hal_shim::words::GripMode;

use super::Fingertip;
use crate::config::Config;
use crate::feedback::Felt;
use crate::grip::Grip;
use crate::hebbian::Learned;
use crate::vibration::Q;

impl Fingertip {
    /// The configuration in force.
    pub const fn config(&self) -> &Config {
        &self.config
    }

    /// The slow frame that the last tick ended, if it ended one.
    pub fn take_slow(&mut self) -> Option<Slow> {
        self.slow.take()
    }

    /// Whether the last tick ended a slow frame that was not taken yet.
    pub const fn has_slow(&self) -> bool {
        self.slow.is_some()
    }

    /// Whether an event waits.
    pub fn has_event(&self) -> bool {
        self.journal.has_event()
    }

    /// Takes the oldest event that waits.
    pub fn next_event(&mut self) -> Option<Event> {
        self.journal.next_event()
    }

    /// Sequence number of the last frame taken.
    pub const fn frame(&self) -> u32 {
        self.journal.frame()
    }

    /// The vibration envelope of each film, samples (14 bits).
    pub fn films(&self) -> [u16; PVDF_COUNT] {
        self.senses.envelopes().map(|envelope| u16::try_from(envelope >> Q).unwrap_or(u16::MAX))
    }

    /// The detectors that report slip, believed or not.
    pub const fn slip(&self) -> DetectorSet {
        self.detectors.slip()
    }

    /// The detectors that warn of slip, believed or not.
    pub const fn incipient(&self) -> DetectorSet {
        self.detectors.incipient()
    }

    /// Duty of the vibration motor until the next call. Call it once a slow frame.
    #[inline(never)]
    pub fn feedback(&mut self) -> Duty {
        let load_mn = if let Grip::Holds(mn) = self.senses.grip { Some(mn) } else { None };
        let (unloaded, lost) = (self.senses.unloaded, self.journal.take_lost());
        self.feedback.step(self.config.feedback, &Felt { mode: self.mode, load_mn, unloaded, lost })
    }

    /// Mode of the reflex.
    pub const fn mode(&self) -> GripMode {
        self.mode
    }

    /// Whether a myosensor is active, its hold time included.
    pub const fn wearer_active(&self) -> bool {
        self.senses.gate.is_active()
    }

    /// Whether the wearer renews the blind budget: a muscle with a healthy myosensor is active, or the button opens the hand.
    /// A lost myosensor counts as active, but renews nothing.
    pub fn wearer_renews(&self) -> bool {
        let gate = &self.senses.gate;
        gate.is_active() && (gate.is_known() || gate.is_releasing() || self.senses.muscles().is_heard())
    }

    /// The Hebbian network's weights, with the maxima of its inputs.
    pub fn learned(&self) -> Learned {
        self.detectors.hebbian.learned()
    }

    /// State of the network for telemetry.
    pub fn network(&self) -> NetworkState {
        self.detectors.hebbian.state(self.journal.frame())
    }

    /// Forces of the last slow frame. None while the force sensor gives no number.
    pub const fn forces(&self) -> Option<Forces> {
        self.senses.forces
    }

    /// The S2 in force, per mille.
    pub fn s2_permille(&self) -> u16 {
        self.detectors.s2.s2_permille(&self.config.friction)
    }
}
