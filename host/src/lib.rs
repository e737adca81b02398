//! The `tenax` tool: runs a scene or a recording on a board, reports, draws, and watches a real board's line.
#![forbid(unsafe_code)]

pub mod board;
pub mod budgets;
pub mod chart;
pub mod check;
pub mod cli;
pub mod crates;
pub mod dataset;
pub mod evaluate;
pub mod guide;
pub mod image;
pub mod input;
pub mod jobs;
pub mod labelled;
pub mod learn;
pub mod link;
pub mod monitor;
pub mod photoelastic;
pub mod plot;
pub mod recipe;
pub mod record;
pub mod replay;
pub mod report;
pub mod scorer;
pub mod serve;
pub mod session;
pub mod settings;
pub mod suggest;
pub mod timeline;
pub mod truth;
pub mod vision;
pub mod web;
pub mod wiring;
