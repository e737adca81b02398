//! Training of the force array's slip detector (Bamshad 2023).
//!
//! A package of its own, so that `tenax run` never compiles what only training needs.

pub mod candidates;
pub mod export;
pub mod features;
pub mod fit;
pub mod linear;
pub mod network;
pub mod quantise;
pub mod report;
pub mod score;
pub mod table;
