//! Worlds in which the fingertip is tried: an object, a gripper, a wearer, and what the sensors make of them.
//! A [`SceneFile`] is parsed from TOML, a [`World`] is built from it and a seed and stepped one scan at a time through
//! [`plant::Plant`]. The same file and seed give the same bytes on every machine: noise is ChaCha8, functions are `libm`'s.
//!
//! ```
//! use tenax_hal_shim::motor::MotorDrive;
//! use tenax_scene::plant::Plant;
//! use tenax_scene::{SceneFile, World, builtin};
//!
//! let (name, text) = builtin()[0];
//! let mut world = World::new(&SceneFile::parse(text, name)?, 1);
//! // A second goes by; nobody drives the motor.
//! for _ in 0..8_000 {
//!     let pins = world.scan(MotorDrive::Coast);
//!     assert!(pins.codes().iter().all(|&code| code < 4_096));
//! }
//! assert!(world.truth().slips.is_empty() && (world.now_s() - 1.0).abs() < 1e-9);
//! # Ok::<(), tenax_scene::SceneError>(())
//! ```
//!
//! | module | |
//! |---|---|
//! | [`physics`] | contact at two levels, gripper, grasped object, stroked surface, hand, wearer |
//! | [`sensor`] | sensors, cameras and their faults |
//! | [`picture`] | pictures of a camera behind a clear skin |
//! | [`act`] | acts of a person at the bench |
//! | [`bound`] | the least force that holds, planned ahead |
//! | [`drawn`] | worlds drawn from stated distributions |
//! | [`truth`] | a log of what happened |
#![forbid(unsafe_code)]

pub mod act;
pub mod bound;
pub mod builtin;
mod causal;
mod commands;
pub mod drawn;
pub mod file;
pub mod physics;
pub mod picture;
pub mod plant;
mod random;
mod schedule;
pub mod sensor;
pub mod stepping;
pub mod truth;
pub mod world;

pub use act::Act;
pub use builtin::builtin;
pub use file::{SceneError, SceneFile};
pub use random::Seeds;
pub use truth::Truth;
pub use world::World;
