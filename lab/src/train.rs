//! Training of the force array's slip detector (Bamshad 2023).

pub mod export;
pub mod features;
pub mod fit;
pub mod network;
pub mod quantise;
pub mod report;
pub mod score;
pub mod table;
