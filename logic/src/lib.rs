//! What the fingertip decides. No heap, no I/O, no clock of its own: time arrives as frames.
//!
//! Data goes one way, and so do the modules:
//!
//! | step | modules |
//! |---|---|
//! | which readings can be used | [`health`]; [`films`] and [`solo`] for PVDF channels |
//! | what they mean | [`vibration`], [`fsr`], [`forces`], [`friction`], [`strain`], [`elements`] and [`mod@array`], [`emg`] and [`gate`] |
//! | a frame through all of them | [`senses`] |
//! | whether the object slips | [`detectors`], the list of them; [`hebbian`] and [`touch`] learn; [`plausibility`] guards |
//! | what to do | [`mode`] and [`grip`], the reflex; [`behaviours`] above it; [`arbiter`] |
//! | the whole | [`fingertip`]; [`journal`] is what it reports |
//! | a fingertip on a line | [`device`]: frames and commands in, drives and messages out. Begin there |
//! | whose commands it carries out | [`session`], [`arming`] |
//!
//! [`config`] and [`settings`] hold every number that can be chosen, and [`store`] keeps what must outlive a power cut.
#![no_std]
// One measured kernel is excepted, `array::dual`; nothing else may be.
#![deny(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod allowance;
pub mod arbiter;
pub mod arming;
pub mod array;
pub mod behaviours;
mod checksum;
pub mod config;
pub mod detectors;
pub mod device;
pub mod elements;
pub mod emg;
pub mod films;
pub mod fingertip;
pub mod forces;
pub mod friction;
pub mod fsr;
pub mod gate;
pub mod grip;
pub mod health;
pub mod hebbian;
pub mod hum;
pub mod journal;
pub mod low_pass;
pub mod mode;
pub mod muscles;
pub mod photoelastic;
pub mod plausibility;
mod samples;
pub mod senses;
pub mod session;
pub mod settings;
pub mod sliding;
pub mod solo;
pub mod store;
pub mod strain;
pub mod stream;
pub mod touch;
pub mod vibration;
