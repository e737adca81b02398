//! All tests of the worlds, one program, so that it is linked once. `--test worlds pvdf_real` runs those of a file.

mod common;

mod bad_files;
mod bases;
mod brush;
mod builtin;
mod objects;
mod patch;
mod photoelastic;
mod pvdf_real;
mod rig;
mod step_bounds;
mod step_margin;
