//! Boards, runs and what is told of them: a scene or a recording becomes a report, a figure and a score.
//!
//! [`session::scene`] runs a scene on a [`session::Board`]; the emulated one is behind the feature `emulator`.
#![forbid(unsafe_code)]

pub mod again;
pub mod array;
pub mod board;
pub mod budgets;
pub mod cli;
pub mod disturbances;
pub mod drawn;
pub mod figure;
pub mod image;
pub mod input;
pub mod jobs;
pub mod labelled;
pub mod live;
pub mod plot;
pub mod recipe;
pub mod replay;
pub mod report;
pub mod scorer;
pub mod session;
pub mod sweep;
pub mod timeline;
