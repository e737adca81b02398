//! The bench on which a fingertip is run: boards with a plant at their pins, and what a run on one leaves behind.
//!
//! Here lives what turns a scene or a recording into a report and its figure, and what scores one: boards, sessions,
//! recordings and their recipes, timelines, reports, the scorer, labelled recordings and the array's network as it is judged.
//! No study (what is asked of many runs, learned or charted), no command line, and no decision of the fingertip's own.
//! It stands on the serial tools, on the plots, on scenes and logic; the studies and the tool stand on it.
//! The emulated board is behind the feature `emulator`; the models under it are `tenax-board-model`'s.
#![forbid(unsafe_code)]

pub mod again;
pub mod array;
pub mod bars;
pub mod board;
pub mod budgets;
pub mod disturbances;
pub mod figure;
pub mod hil;
pub mod image;
pub mod input;
pub mod jobs;
pub mod labelled;
pub mod live;
pub mod recipe;
pub mod replay;
pub mod report;
pub mod scorer;
pub mod session;
pub mod timeline;
