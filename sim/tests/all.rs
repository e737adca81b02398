//! Tests that need neither the emulated board nor real time, as one program: `--test all failures` runs those of a file.

mod common;

mod behaviours;
mod cases;
mod cut_wires;
mod drawn;
mod drift;
mod failures;
mod feedback;
mod golden;
mod gripper;
mod kept;
mod lines;
mod onsets;
mod recipes;
mod recordings;
mod reflex;
mod relax;
mod replay;
mod report;
mod rows;
mod sliding;
mod subsets;
