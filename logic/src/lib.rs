//! The decisions of the fingertip: sensor samples in, motor drive out. No heap, no I/O, no clock: time is counted in frames of 0.5 ms.
//!
//! | step | modules, in the order in which data passes them |
//! |---|---|
//! | valid readings | [`health`] |
//! | one sense each: readings, quantities, detector | [`vibration`], [`force`], [`strain`], [`mod@array`], [`hebbian`], [`photoelastic`]; [`emg`] and [`gate`] of the wearer |
//! | a frame through all of them | [`senses`] |
//! | slip | [`detectors`]; [`plausibility`] guards |
//! | reaction | [`mode`] and [`grip`], the reflex; [`behaviours`]; [`arbiter`]; [`motor`] limits stall and heat; [`feedback`] to the wearer |
//! | the whole fingertip | [`fingertip`]; [`journal`] collects its reports |
//! | a fingertip on a line | [`device`]: begin there |
//! | accepted commands | [`session`], [`arming`] |
//! | numbers | [`config`] and [`setting`]; [`store`] saves settings, zero, weights and calibration |
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod account;
pub mod allowance;
pub mod arbiter;
pub mod arming;
pub mod array;
pub mod behaviours;
pub mod button;
mod checksum;
pub mod config;
pub mod detectors;
pub mod device;
pub mod emg;
pub mod evidence;
pub mod feedback;
pub mod fingertip;
pub mod force;
pub mod gate;
pub mod grip;
pub mod health;
pub mod hebbian;
pub mod journal;
mod latest;
pub mod low_pass;
pub mod mode;
pub mod motor;
pub mod muscles;
pub mod photoelastic;
pub mod plausibility;
pub mod rescue;
pub mod restart;
pub mod samples;
pub mod senses;
pub mod session;
pub mod setting;
pub mod store;
pub mod strain;
pub mod stream;
pub mod vibration;
