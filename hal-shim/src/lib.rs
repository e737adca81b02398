//! The line between Tenax's logic and its hardware.
//!
//! In the order of the data: [`channel`] maps signals to pins, [`schedule`] to slots; [`frame`] holds the samples that a board gives to the
//! logic every 0.5 ms, [`motor`] the drive that it gets back. [`detector`] lists the detectors; [`words`] has the names of states and
//! faults; [`wire`] has the messages of the serial line; [`flash`] is the trait of the memory that outlives a power cut. Nothing here
//! decides anything.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod behaviour;
pub mod channel;
pub mod detector;
pub mod flash;
pub mod frame;
pub mod front_end;
pub mod motor;
pub mod schedule;
pub mod wire;
pub mod words;
