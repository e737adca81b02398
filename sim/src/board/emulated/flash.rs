//! The flash as an array of words, which `rigless` leaves out: what a store and the end of an erase do to them, with the core standing
//! still meanwhile (RM0383, section 3.5). The chip's memories are the F411's, not the F427's.

use std::iter::repeat_n;
use std::num::{NonZeroU32, NonZeroU64};

use rigless::device::{ErasedDevice, ResetCause};
use rigless::emulator::{Access, AccessKind, Host, Stop};
use rigless::mcu::Mcu;
use rigless::session::Session;
use rigless::soc::stm32f427::generated::flash::Register;
use rigless::soc::stm32f427::{CPU, Stm32f427};
use rigless::soc::{Bus, EraseBlocks, Error, Region, Width};
use rigless::time::VirtualNanos;

use super::nucleo::Nucleo;

const INTERFACE: &str = "FLASH";
const FLASH_CR: u64 = 0x4002_3C10;
const FLASH_SR: u64 = 0x4002_3C0C;
pub const OPTKEYR: u64 = 0x4002_3C08;
pub const OPTCR: u64 = 0x4002_3C14;

const CR_PG: u64 = 1;
const CR_SER: u64 = 1 << 1;
const CR_SNB_SHIFT: u64 = 3;
const CR_SNB: u64 = 0xF;
const CR_PSIZE: u64 = 0b11 << 8;
const CR_PSIZE_WORD: u64 = 0b10 << 8;
const CR_LOCK: u64 = 1 << 31;
const SR_PGSERR: u64 = 1 << 7;
const SR_BSY: u64 = 1 << 16;

const BASE: u64 = 0x0800_0000;
const SIZE: u64 = 512 << 10;

const fn blocks(size: u64, count: u32) -> EraseBlocks {
    EraseBlocks {
        size: NonZeroU64::new(size).expect("not zero"),
        count: NonZeroU32::new(count).expect("not zero"),
    }
}

/// RM0383, table 4.
static SECTORS: [EraseBlocks; 3] = [blocks(16 << 10, 4), blocks(64 << 10, 1), blocks(128 << 10, 3)];

/// RM0383, section 2.3, with the system memory whole.
static MEMORY: [Region; 3] = [
    Region::flash("flash", BASE, SIZE).erased_in(&SECTORS).erased_to(0xFF).programmed_by(INTERFACE),
    Region::system("system", 0x1FFF_0000, 32 << 10),
    Region::ram("sram", 0x2000_0000, 128 << 10),
];

#[derive(Debug)]
pub struct MemoryMap(Bus);

impl MemoryMap {
    pub fn new(mcu: &Stm32f427) -> Result<Self, Error> {
        let peripherals: Vec<_> = mcu.bus().peripherals().copied().collect();
        Ok(Self(Bus::builder(CPU, &MEMORY, peripherals).build()?))
    }
}

impl Mcu for MemoryMap {
    fn bus(&self) -> &Bus {
        &self.0
    }

    fn bus_mut(&mut self) -> &mut Bus {
        &mut self.0
    }

    fn reset(&mut self, _at: VirtualNanos, _cause: ResetCause) {
        self.0.reset();
    }

    fn poll(&mut self, _now: VirtualNanos) {}

    fn split(&mut self, _slot: usize) -> (&mut Bus, Option<&mut dyn ErasedDevice>) {
        (&mut self.0, None)
    }
}

#[derive(Debug, Default)]
pub struct FlashArray {
    doing: Option<Doing>,
    word_ns: u64,
    pub words: u64,
    pub erases: u64,
    power: Option<u32>,
    pub options_written: bool,
}

#[derive(Clone, Copy, Debug)]
enum Doing {
    Programs { until: VirtualNanos },
    Erases { sector: u64 },
}

impl FlashArray {
    /// One that takes so long for a word, ns.
    pub fn new(word_ns: u64) -> Self {
        Self { word_ns, ..Self::default() }
    }

    /// Cuts the power while the word after the next `words` is programmed: half of its bits are.
    pub fn cut_power_after(&mut self, words: u32) {
        self.power = Some(words);
    }

    pub fn accessed(&mut self, access: &Access, session: &mut Session<Nucleo>, host: &mut dyn Host) {
        if access.kind != AccessKind::Write {
            return;
        }
        if (BASE..BASE + SIZE).contains(&access.address) {
            self.store(access, session, host);
        } else if [OPTKEYR, OPTCR].contains(&access.address) {
            self.options_written = true;
        } else if access.address == FLASH_CR {
            let (board, now) = (session.board_mut(), access.virtual_time);
            let control = board.peek(now, FLASH_CR);
            let busy = board.peek(now, FLASH_SR) & SR_BSY != 0;
            if busy && control & CR_SER != 0 && self.doing.is_none() {
                self.doing = Some(Doing::Erases { sector: control >> CR_SNB_SHIFT & CR_SNB });
                host.hold(true);
            }
        }
    }

    fn store(&mut self, access: &Access, session: &mut Session<Nucleo>, host: &mut dyn Host) {
        let board = session.board_mut();
        let control = board.peek(access.virtual_time, FLASH_CR);
        let ready = control & (CR_PG | CR_LOCK | CR_SER) == CR_PG && control & CR_PSIZE == CR_PSIZE_WORD;
        if !ready || access.width != Width::W32 || !access.address.is_multiple_of(4) {
            fail(&mut board.chip);
            return;
        }
        let old = host.read(access.address, Width::W32).unwrap_or(0);
        let mut programmed = old & access.value;
        let cut = self.power.take_if(|words| *words == 0).is_some();
        if cut {
            programmed |= old & 0xFFFF_0000;
        } else if let Some(words) = &mut self.power {
            *words -= 1;
        }
        let landed = host.program(access.address, Width::W32, programmed);
        debug_assert!(landed.is_ok(), "{:#x} is in the flash", access.address);
        self.words += 1;
        if cut {
            // Power that comes back at once: the reset is the pin's, which the image tells from its own.
            session.reset_by_pin(access.virtual_time, access.instruction_count, host);
            return;
        }
        let until = VirtualNanos(access.virtual_time.0 + self.word_ns);
        self.doing = Some(Doing::Programs { until });
        session.pause_at(Some(until));
        host.hold(true);
    }

    pub fn stopped(&mut self, stop: Stop, session: &mut Session<Nucleo>, host: &mut dyn Host) {
        let over = match self.doing {
            None => false,
            Some(Doing::Programs { until }) => stop.at >= until,
            Some(Doing::Erases { sector }) => {
                let over = session.board_mut().peek(stop.at, FLASH_SR) & SR_BSY == 0;
                if over {
                    erase(sector, host);
                    self.erases += 1;
                }
                over
            }
        };
        if over {
            self.doing = None;
            session.pause_at(None);
            host.hold(false);
        }
    }

    pub fn reset(&mut self) {
        self.doing = None;
    }
}

fn fail(chip: &mut Stm32f427) {
    let bus = chip.bus_mut();
    if let Some(slot) = bus.slot_of(INTERFACE) {
        let registers = bus.slot_mut(slot).registers_mut();
        let status = registers.get(Register::Sr);
        registers.set(Register::Sr, status | SR_PGSERR);
    }
}

fn erase(sector: u64, host: &mut dyn Host) {
    let mut sizes = SECTORS.iter().flat_map(|run| repeat_n(run.size.get(), run.count.get() as usize));
    let begins = BASE + sizes.by_ref().take(sector as usize).sum::<u64>();
    let ends = begins + sizes.next().unwrap_or(0);
    for word in (begins..ends).step_by(8) {
        let landed = host.program(word, Width::W64, u64::MAX);
        debug_assert!(landed.is_ok(), "{word:#x} is in the flash");
    }
}
