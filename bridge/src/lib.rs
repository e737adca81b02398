//! Fingertips' lines in ROS 2's graph: [`network`] is zenoh as rmw_zenoh has it set, [`hand`] one line with its topics.
#![forbid(unsafe_code)]
#![allow(missing_docs, reason = "a part of the tool: where a name says it all, nothing repeats it")]

pub mod hand;
pub mod network;
