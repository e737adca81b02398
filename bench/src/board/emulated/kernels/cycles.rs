//! Cycles of kernels, estimated from every instruction that the emulated core executes in them: see [`timing`](crate::image::timing).

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};
use object::{File, Object, ObjectSection};
use rigless::emulator::Watch;
use rigless::session::Session;
use tenax_board_model::nucleo::Nucleo;
use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;
use tenax_hal_shim::frame::Frame;
use tenax_logic::array::Reading;

use super::Kernels;
use crate::image::calls::Calls;
use crate::image::kernels::{Kernel, KernelSymbols, PREFIX};
use crate::image::symbols::{Symbols, TICK};
use crate::image::timing::{Core, Cycles, Flash, Instruction};

/// Follows the core through the kernels, one instruction at a time.
#[derive(Debug)]
pub struct Tracer {
    code: BTreeMap<u64, Instruction>,
    kernels: Vec<(Kernel, Option<Core>, u64, Cycles)>,
    last: Option<u64>,
    flash: Flash,
}

impl Tracer {
    /// One for the kernels of an image, in this flash. Fails if it is none.
    pub fn new(elf: &Path, symbols: &KernelSymbols, flash: Flash) -> Result<Self> {
        Self::of(elf, &symbols.kernels, |name| name.starts_with(PREFIX), flash)
    }

    /// One for the tick of the image that is flashed. Fails if it is none.
    pub fn of_tick(elf: &Path, symbols: &Symbols) -> Result<Self> {
        let tick = Kernel { name: TICK.to_owned(), entry: symbols.tick, after: vec![symbols.after_tick] };
        Self::of(elf, &[tick], |name| name == TICK, Flash::F411)
    }

    fn of(elf: &Path, kernels: &[Kernel], is_root: impl Fn(&str) -> bool, flash: Flash) -> Result<Self> {
        let bytes = std::fs::read(elf).with_context(|| format!("reading the image {}", elf.display()))?;
        let file = File::parse(&*bytes).context("not an ELF file")?;
        let text = file.section_by_name(".text").context("has no .text section")?;
        let (base, data) = (text.address(), text.data()?);
        let half = |at: u64| {
            let bytes = data.get((at - base) as usize..).and_then(<[u8]>::first_chunk::<2>);
            bytes.map_or(0, |bytes| u16::from_le_bytes(*bytes))
        };
        let calls = Calls::of(&file)?;
        let reached = calls.reached(&calls.named(is_root));
        let mut code = BTreeMap::new();
        for &place in reached.keys() {
            for at in calls.0[place].instructions.iter().copied() {
                code.insert(at, Instruction::of(half(at), half(at + 2)));
            }
        }
        let kernels = kernels.iter().map(|own| (own.clone(), None, 0, Cycles::default())).collect();
        Ok(Self { code, kernels, last: None, flash })
    }

    /// The instructions to be told about.
    pub fn watched(&self) -> impl Iterator<Item = u64> {
        self.code.keys().copied()
    }

    /// The core is about to run an instruction.
    pub fn hit(&mut self, address: u64) {
        let next = (address, self.code.get(&address).copied());
        let last = self.last.take().and_then(|at| Some((at, *self.code.get(&at)?)));
        for (kernel, core, calls, sum) in &mut self.kernels {
            if let (Some(core), Some((at, own))) = (core.as_mut(), last) {
                core.execute(at, own, next);
            }
            if kernel.after.contains(&address)
                && let Some(core) = core.take()
            {
                *calls += 1;
                sum.least += core.cycles.least;
                sum.likely += core.cycles.likely;
                sum.most += core.cycles.most;
            }
            if address == kernel.entry {
                *core = Some(Core::cold(self.flash));
            }
        }
        self.last = Some(address);
    }

    /// The mean of each kernel's calls: least, likely, most.
    pub fn means(&self) -> BTreeMap<String, [f64; 3]> {
        let ran = self.kernels.iter().filter(|(_, _, calls, _)| *calls > 0);
        ran.map(|(kernel, _, calls, sum)| {
            let mean = |cycles: u64| cycles as f64 / *calls as f64;
            (kernel.name.clone(), [mean(sum.least), mean(sum.likely), mean(sum.most)])
        })
        .collect()
    }
}

/// Follows some ticks of the image that is flashed.
#[derive(Debug)]
pub struct Followed {
    tracer: Tracer,
    /// From which tick on.
    from: u64,
    /// Whether every instruction is watched.
    watches: bool,
}

impl Followed {
    /// Ticks that are followed: each slot of ten cycles.
    const TICKS: u64 = 250;

    /// From this tick on. Fails if it is not the image.
    pub fn new(elf: &Path, symbols: &Symbols, from: u64) -> Result<Self> {
        Ok(Self { tracer: Tracer::of_tick(elf, symbols)?, from, watches: false })
    }

    /// The core is about to run an instruction; so many ticks have ended.
    pub fn hit(&mut self, address: u64, ticks: u64, session: &mut Session<Nucleo>) {
        let wanted = (self.from..self.from + Self::TICKS).contains(&ticks);
        if self.watches {
            self.tracer.hit(address);
        }
        if wanted != self.watches {
            self.watches = wanted;
            for address in self.tracer.watched().map(Watch::Instruction) {
                if wanted { session.watch(address) } else { session.unwatch(address) }
            }
        }
    }

    /// The mean tick: least, likely, most cycles.
    pub fn mean(&self) -> Option<[f64; 3]> {
        self.tracer.means().into_values().next()
    }
}

/// Cycles before the kernels are followed, each a reading and 25 frames: the array's windows are full by then; and how many are followed.
const BEFORE: usize = 60;
const FOLLOWED: usize = 10;

/// Estimates every kernel of the image on `frames`, which begin with a cycle: least, likely, most cycles, means of the calls. `readings`
/// are the array's. Fails as [`run`](super::run) does.
pub fn cycles(image: &Path, readings: &[Reading], frames: &[Frame]) -> Result<BTreeMap<String, [f64; 3]>> {
    let per = usize::from(FRAMES_PER_SLOW_FRAME);
    let readings = readings.get(..BEFORE + FOLLOWED).unwrap_or(readings).to_vec();
    let frames = frames.get(..(BEFORE + FOLLOWED) * per).unwrap_or(frames);
    let follow = |readings: &[Vec<Reading>], frames: &[Frame], from: usize| {
        super::followed(image, readings, frames, Some((from, Flash::F411)), Kernels::Detector, &mut |_| {})
    };
    let mut all = follow(&[readings], &[], BEFORE)?.cycles;
    all.extend(follow(&[], frames, BEFORE * per)?.cycles);
    Ok(all)
}

/// Estimates the kernels of a stranger's image, called once each for the one reading that it is given.
pub fn of_image(image: &Path, flash: Flash) -> Result<BTreeMap<String, [f64; 3]>> {
    let readings = [vec![Reading::default()]];
    Ok(super::followed(image, &readings, &[], Some((0, flash)), Kernels::Detector, &mut |_| {})?.cycles)
}
