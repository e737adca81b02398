//! The image for the microcontroller: building it, and reading what it says about itself.

pub mod calls;
pub mod kernels;
pub mod panics;
pub mod pointers;
pub mod size;
pub mod stack;
pub mod symbols;
pub mod timing;

use std::path::{Path, PathBuf};

use anyhow::Result;
use tenax_launch::image::Binary;
pub use tenax_launch::image::{TARGET, clippy};

/// Builds the image of the workspace at `root`, fetching what it takes, and gives its ELF file.
/// An error says what to install, or what the compiler said.
pub fn build(root: &Path) -> Result<PathBuf> {
    tenax_launch::image::build(root, Binary::Image)
}

/// Builds the image of every detector's kernels, for [`run_frames`](crate::board::emulated::kernels::run_frames). Fails as [`build`] does.
pub fn build_frames(root: &Path) -> Result<PathBuf> {
    tenax_launch::image::build(root, Binary::Frames)
}

/// Builds the image of a small camera, for [`pictures`](crate::board::emulated::kernels::pictures). Fails as [`build`] does.
pub fn build_pictures(root: &Path) -> Result<PathBuf> {
    tenax_launch::image::build(root, Binary::Pictures)
}

/// Builds the image of the array detector's kernels, for [`kernels`](crate::board::emulated::kernels). Fails as [`build`] does.
pub fn build_kernels(root: &Path) -> Result<PathBuf> {
    tenax_launch::image::build(root, Binary::Kernels)
}
