//! A small camera on the emulated core: what it sees in any pictures, and what that costs. The image is `firmware/src/bin/pictures`.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use rigless::emulator::{self, Driver, Error, Host, Settled, Start, Stop, Watch};
use rigless::image::Image;
use rigless::session::Session;
use rigless::soc::Width;
use rigless::time::VirtualNanos;
use tenax_board_model::Models;
use tenax_board_model::line::Line;
use tenax_board_model::nucleo::Nucleo;

use super::INSTRUCTIONS_PER_SECOND;
use super::meter::{Cost, Meters};
use crate::image::kernels::PictureSymbols;

/// Between two looks at whether it is over: a million instructions.
const LOOK_NS: u64 = 10_000_000;
/// Looks without a new picture after which the core is given up.
const PATIENCE: u32 = 200;

#[derive(Clone, Debug)]
pub struct Picture {
    /// Its planes, green, blue and red.
    pub gbrp: Vec<u8>,
    pub taken_ms: u32,
    /// Whether the object's colours are learned.
    pub learn: bool,
}

#[derive(Debug)]
pub struct Outcome {
    /// What the core said of each picture.
    pub said: Vec<String>,
    /// All that a picture takes, and its parts.
    pub costs: Vec<Cost>,
    /// RAM that was used, bytes: heap, variables and the deepest stack.
    pub ram: [u64; 3],
}

struct Feed {
    symbols: PictureSymbols,
    pictures: Vec<Picture>,
    fed: usize,
    meters: Meters,
    said: Vec<String>,
    ram: Option<[u64; 3]>,
    looks: u32,
}

/// Puts pictures through the camera of the `image`. Fails if its core does not come back for the next one.
pub fn run(image: &Path, pictures: Vec<Picture>) -> Result<Outcome> {
    let symbols = PictureSymbols::read(image)?;
    let images = [Image::read(image, None).context("reading the image")?];
    let board = Nucleo::new(Models::Quick, INSTRUCTIONS_PER_SECOND, Line::default())?.with_axi()?;
    let mut session = Session::new(Box::new(board), 0, VirtualNanos(1))?;
    for address in Meters::watched(&symbols.kernels).chain([symbols.next]) {
        session.watch(Watch::Instruction(address));
    }
    let meters = Meters::new(&symbols.kernels);
    let feed = Feed { symbols, pictures, fed: 0, meters, said: Vec::new(), ram: None, looks: 0 };
    let feed = emulator::run(session, &Start::new(&images), feed).context("the emulator")?.driver;
    ensure!(
        feed.ram.is_some(),
        "the camera's image stopped at picture {}: has it panicked?",
        feed.said.len()
    );
    Ok(Outcome { said: feed.said, costs: feed.meters.into_costs(), ram: feed.ram.unwrap_or_default() })
}

impl Feed {
    /// The core stands: takes the answer out, puts the next picture in.
    fn exchange(&mut self, host: &mut dyn Host) -> Result<(), Error> {
        self.looks = 0;
        if self.fed > 0 {
            let mut said = String::new();
            for at in self.symbols.said.. {
                match host.read(at, Width::W8)? {
                    0 => break,
                    byte => said.push(char::from(byte as u8)),
                }
            }
            self.said.push(said);
        }
        let Some(picture) = self.pictures.get(self.fed) else {
            let stack = self.symbols.stack.clone();
            // RAM is 0 where nobody has written.
            let mut deepest = stack.start;
            while deepest < stack.end && host.read(deepest, Width::W32)? == 0 {
                deepest += 4;
            }
            let heap = host.read(self.symbols.heap, Width::W32)?;
            self.ram = Some([heap, self.symbols.variables, stack.end - deepest]);
            return Ok(());
        };
        for (n, plane) in picture.gbrp.chunks_exact(picture.gbrp.len() / 3).enumerate() {
            let begin = host.read(self.symbols.planes + 4 * n as u64, Width::W32)?;
            for (at, word) in plane.as_chunks::<4>().0.iter().enumerate() {
                host.write(begin + 4 * at as u64, Width::W32, u32::from_le_bytes(*word).into())?;
            }
        }
        let orders = u64::from(picture.taken_ms << 1 | u32::from(picture.learn));
        host.write(self.symbols.orders, Width::W32, orders)?;
        self.fed += 1;
        Ok(())
    }
}

impl Driver<Nucleo> for Feed {
    fn on_settled(&mut self, _: &mut Session<Nucleo>, host: &mut dyn Host, settled: Settled) {
        let Settled::Hit(hit) = settled else { return };
        if self.ram.is_some() {
            return;
        }
        self.meters.hit(hit.address, hit.instruction_count);
        if hit.address == self.symbols.next {
            self.exchange(host).expect("it is in the image's memory");
        }
    }

    fn on_stop(&mut self, _: &mut Session<Nucleo>, stop: Stop, _: &mut dyn Host) -> Option<VirtualNanos> {
        self.looks += 1;
        let over = self.ram.is_some() || self.looks > PATIENCE;
        (!over).then_some(VirtualNanos(stop.at.0 + LOOK_NS))
    }
}
