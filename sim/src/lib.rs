//! Boards, runs and what is told of them: a scene or a recording becomes a report, a figure and a score.
//!
//! [`session::scene`] runs a scene on a [`session::Board`]; the emulated one is behind the feature `emulator`.
#![forbid(unsafe_code)]

#[cfg(feature = "host")]
pub mod again;
pub mod board;
#[cfg(feature = "host")]
pub mod budgets;
#[cfg(feature = "host")]
pub mod cli;
#[cfg(feature = "host")]
pub mod drawn;
#[cfg(feature = "host")]
pub mod figure;
#[cfg(feature = "host")]
pub mod image;
#[cfg(feature = "host")]
pub mod input;
#[cfg(feature = "host")]
pub mod jobs;
#[cfg(feature = "host")]
pub mod live;
#[cfg(feature = "host")]
pub mod plot;
#[cfg(feature = "host")]
pub mod replay;
#[cfg(feature = "host")]
pub mod report;
#[cfg(feature = "host")]
pub mod scorer;
#[cfg(feature = "host")]
pub mod session;
#[cfg(feature = "host")]
pub mod sweep;
#[cfg(feature = "host")]
pub mod timeline;
