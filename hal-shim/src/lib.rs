//! The line between Tenax's logic and its hardware.
//!
//! What crosses it, in the order in which data goes: [`channel`] says which signal is on which pin, [`schedule`] in which
//! slot it is read, [`frame`] is what a board hands to the logic every 0.5 ms, [`motor`] is what the logic hands back.
//! [`detector`] lists the detectors; [`words`] are the states and faults that both sides and
//! a person watching call by the same names. [`wire`] is how all of it travels over the serial line, and [`flash`] is where
//! a board keeps what must outlive a power cut. Nothing here decides anything.
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
