//! All tests of the logic in closed loops, one program: linking one for each file took longer than running most of them.
//! `--test fingertip wearer` runs those of a file.

mod adversary;
mod array;
mod behaviours;
mod button;
mod calibration;
mod consent;
mod detector;
mod emg;
mod feedback;
mod hebbian;
mod motor;
mod myosensor_faults;
mod no_wearer;
mod random_steps;
mod ranges;
mod reflex;
mod restart;
mod select_lines;
mod shear;
mod sliding;
mod store;
mod touch;
mod wearer;
