//! Studies: what many runs on the bench show of the fingertip, as figures for the pages of docs/.
//!
//! Here lives what teaches, evaluates, makes data sets, draws charts and looks through a camera or a photoelastic skin: each
//! behind one command of the tool, which prints what it gives.
//! No board, no report or score of a single run (the bench's), no command line (the tool's).
//! A number of a page is made here, by one command that the page names; nothing else depends on this crate but the tool.
//! One study may use another's result (charts draw the others'), never the other way round.
#![forbid(unsafe_code)]

pub mod chart;
pub mod dataset;
pub mod equations;
pub mod evaluate;
pub mod learn;
pub mod photoelastic;
pub mod sweep;
pub mod vision;
