//! The tests of the palm, one program: `--test all attacks` runs those of a file.

mod attacks;
mod share;
mod wishes;
