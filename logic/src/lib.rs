//! What the fingertip decides. No heap, no I/O, no clock of its own: time arrives as frames.
#![no_std]
#![forbid(unsafe_code)]

pub mod fingertip;
