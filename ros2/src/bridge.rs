//! Fingertips' lines in ROS 2's graph: [`network`] is zenoh as rmw_zenoh has it set, [`hand`] one line with its topics.

pub mod action;
pub mod hand;
pub mod network;
