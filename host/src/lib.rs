//! The `tenax` tool: runs a scene or a recording on a board, reports, draws, and watches a real board's line.
#![forbid(unsafe_code)]

pub mod board;
