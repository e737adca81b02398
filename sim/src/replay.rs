//! Recordings: a CSV file and a recipe become a plant that any board can be connected to.
//!
//! The recording is what somebody's sensors gave; the recipe is the analogue front end that would have stood between
//! those sensors and this board's pins. Nothing here knows what a detector is.

pub mod facts;
pub mod filter;
pub mod library;
pub mod meaning;
pub mod muscles;
pub mod plant;
pub mod recipe;
pub mod recording;
pub mod resample;

pub use plant::ReplayPlant;
pub use recipe::Recipe;
pub use recording::Recording;
