//! A board's line, served in this process, and the commands at the other end of it.
//! One program for all of them: most wait for real time to go by, so that two at once take no longer than one.
#![cfg(unix)]

mod calibrate;
mod config;
mod lines;
mod page;
mod play;
mod recording;
mod selftest;
mod served;
mod serving;
mod tables;
mod whole;
