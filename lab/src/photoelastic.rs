//! A bench for the photoelastic head: the scene's head at the logic's, without a hand around them.

pub mod balance;
pub mod bench;
pub mod force;
pub mod rate;
pub mod region;
