//! The tests of the serial tools, one program: `--test all bringup` runs those of a file.

#[cfg(unix)]
mod bringup;
mod index;
mod layouts;
mod settings;
mod wiring;
