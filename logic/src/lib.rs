//! What the fingertip decides. No heap, no I/O, no clock of its own: time arrives as frames.
//!
//! Data goes one way, and so do the modules: [`health`] says which readings can be believed, [`films`] those of the
//! films; [`vibration`] (S1), [`fsr`], [`forces`] and [`friction`] (S2), [`strain`], [`array`] and [`gate`] (the wearer's muscles) say what they mean;
//! [`senses`] puts a frame through all of them; [`detectors`] is the list of what judges it, guarded by [`plausibility`],
//! and [`touch`] learns slip ([`hebbian`]); [`mode`], [`grip`] and [`arbiter`] decide; [`fingertip`] is the whole, and [`journal`] is
//! what it tells. [`config`] holds every number that can be chosen, and [`store`] keeps what must outlive a power cut.
#![no_std]
// One measured kernel is excepted, `array::dual`; nothing else may be.
#![deny(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod arbiter;
pub mod array;
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
pub mod journal;
pub mod low_pass;
pub mod mode;
pub mod muscles;
pub mod plausibility;
mod samples;
pub mod senses;
pub mod settings;
pub mod store;
pub mod strain;
pub mod touch;
pub mod vibration;
