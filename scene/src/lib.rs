//! The smallest worlds in which the fingertip can be tried: an object, a gripper, a wearer, and what the sensors make
//! of them. No detector lives here.
#![forbid(unsafe_code)]

pub mod plant;
