//! Recordings: a CSV file and a recipe become a plant that any board can be connected to.
//!
//! The recording is what somebody's sensors gave; the recipe is the analogue front end that would have stood between
//! those sensors and this board's pins. Nothing here knows what a detector is.
//!
//! ```
//! use crate::recipe::Kind;
//! use crate::replay::{Recipe, Recording, ReplayPlant};
//! use tenax_scene::plant::Plant;
//!
//! let csv = "t,film\n0,0.00\n0.0005,0.02\n0.001,-0.01\n";
//! let recording = Recording::parse(csv.as_bytes(), "touch.csv")?;
//! assert_eq!(recording.series("film")?, [0.0, 0.02, -0.01]);
//! let recipe = "title = 'One film'\ndescription = 'an amplifier of 20'\n\
//!               [[map]]\ncolumn = 'film'\nchannels = ['pvdf_1']\ngain = 20.0\n";
//! let plant = ReplayPlant::new(&recording, &Recipe::parse(recipe, "one-film.toml")?, 1)?;
//! // A second before, for the filters to settle, and 0.2 s after.
//! assert!((plant.duration_s() - 1.201).abs() < 1e-3);
//! # Ok::<(), anyhow::Error>(())
//! ```

pub mod calibrate;
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
