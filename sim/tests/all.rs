//! The bench's tests that need neither the emulated board nor real time, one program: linking one for each file took CI half a minute, and while the
//! last test of a program ran its other cores had nothing to do. `--test all failures` runs those of a file.

mod common;

mod acts;
mod behaviours;
mod cut_wires;
mod emg;
mod failures;
mod feedback;
mod figure;
mod golden;
mod gripper;
mod motor;
mod onsets;
mod recipes;
mod recordings;
mod reflex;
mod relax;
mod replay;
mod report;
mod sliding;
mod subsets;
