//! Recordings: a CSV file and a recipe, the analogue front end between somebody's sensors and the pins, become a plant.

pub mod facts;
pub mod filter;
pub mod library;
pub mod meaning;
pub mod muscles;
pub mod plant;
pub mod recipe;
pub mod recording;
pub mod resample;
pub mod suggest;

pub use plant::ReplayPlant;
pub use recipe::Recipe;
pub use recording::Recording;
