//! A board's line, served to whoever listens: the tool's commands, its page and its screen at the other end of it.
//!
//! One program for all of them: most of them wait for real time to go by, so that two at once take no longer than one.

#[cfg(unix)]
mod browser;
#[cfg(unix)]
mod calibrate;
#[cfg(unix)]
mod config;
mod host_line;
#[cfg(unix)]
mod journey;
#[cfg(unix)]
mod monitor;
#[cfg(unix)]
mod page;
#[cfg(unix)]
mod page_bench;
mod picture;
#[cfg(unix)]
mod python;
mod recording;
mod screen;
#[cfg(unix)]
mod selftest;
#[cfg(unix)]
mod served;
mod served_noise;
#[cfg(unix)]
mod serving;
#[cfg(unix)]
mod suggest;
mod tool;
#[cfg(unix)]
mod vision_served;
