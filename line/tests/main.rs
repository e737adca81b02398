//! A board's line, served to whoever listens: the tool's commands, its page and its screen at the other end of it.
//!
//! One program for all of them: most of them wait for real time to go by, so that two at once take no longer than one.
#![cfg(unix)]

mod browser;
mod calibrate;
mod config;
mod host_line;
mod journey;
mod monitor;
mod page;
mod page_bench;
mod picture;
mod python;
mod recording;
mod screen;
mod selftest;
mod served;
mod served_noise;
mod serving;
mod suggest;
mod tool;
mod vision_served;
