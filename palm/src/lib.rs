//! A hand of several fingertips: the bus between them and a palm, and how the palm shares the force.
//!
//! [`bus`] has the words of the bus, [`finger`] a finger's end of it, [`palm`] the palm's. [`clock`] brings a finger's time to the
//! palm's, and [`share`] allots the least forces that keep each finger's margin. [`places`] says which fingers a hand has, [`line`] what
//! goes between the palm and a PC. Who owns a serial port moves the bytes; nothing here waits, allocates or knows a
//! pin. [`can`] has what a fingertip says where no palm asks.
//!
//! The palm only adds evidence. It warns a finger's reflex, which answers as it answers its own warnings: below the ceiling, never while a
//! muscle is active, never by opening. `docs/hand.md` lists the degraded hands.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod bus;
pub mod can;
pub mod clock;
pub mod finger;
pub mod line;
pub mod palm;
pub mod places;
pub mod share;
