//! `tenax size`: what the image takes of the chip.

use std::process::ExitCode;

use super::progress::Progress;
use super::workspace;
use crate::image;
use crate::image::size::{FLASH_BYTES, RAM_BYTES, Size};
use crate::session::{self, Board};

pub fn main() -> anyhow::Result<ExitCode> {
    let root = workspace::root()?;
    let size = Size::read(&image::build(&root)?)?;
    print("flash", size.flash, FLASH_BYTES);
    print("RAM, variables", size.ram, RAM_BYTES);
    let board = match Board::emulated(&root) {
        Ok(board) => board,
        Err(error) => {
            println!("worst stack     not measured: {error}");
            return Ok(ExitCode::SUCCESS);
        }
    };
    let file = session::load_scene(session::DEFAULT_SCENE)?;
    let mut progress = Progress::new("worst stack", file.duration_s());
    let outcome = session::scene(&file, 1, &board, &mut |s| progress.at(s))?;
    drop(progress);
    match outcome.report.stack_bytes {
        Some(bytes) => print("worst stack", bytes, RAM_BYTES - size.ram),
        None => println!("worst stack     not measured on this board"),
    }
    Ok(ExitCode::SUCCESS)
}

fn print(what: &str, bytes: u64, of: u64) {
    println!("{what:<16}{bytes:>7} of {of} bytes, {:.1} %", 100.0 * bytes as f64 / of as f64);
}
