//! The papers' studies: what many runs show of the fingertip, as reports and charts.
//! A folder a study, a file a command in [`cli`]. One study may use another's result (charts draw the others'), never the reverse.
#![forbid(unsafe_code)]

pub mod chart;
pub mod check;
pub mod cli;
pub mod dataset;
pub mod equations;
pub mod evaluate;
pub mod learn;
pub mod vision;
