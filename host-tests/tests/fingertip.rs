//! All tests of the logic in closed loops, as one program. `--test fingertip wearer` runs those of a file.

mod account;
mod adversary;
mod array;
mod behaviours;
mod button;
mod calibration;
mod consent;
mod emg;
mod feedback;
mod hebbian;
mod motor;
mod myosensor_faults;
mod no_wearer;
mod ranges;
mod reflex;
mod restart;
mod select_lines;
mod shear;
mod sliding;
mod store;
mod touch;
mod wearer;
