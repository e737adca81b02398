//! The tests of vision but for that of the allocator, one program: `--test all markers` runs those of a file.

mod common;

mod markers;
mod object;
mod real_markers;
mod real_object;
