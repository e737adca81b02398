//! The NUCLEO-F411RE as the emulator sees it.
//!
//! `rigless` has no STM32F411, but its STM32F427 has every peripheral that this chip has, at the same addresses, and runs
//! the unmodified image. What differs is not used: more timers, a faster clock. The memories are the F411's.

use std::num::{NonZeroU32, NonZeroU64};

use rigless::cpu::armv7m::windows;
use rigless::machine::armv7m::{Core, Fpu, MpuRegions, Variant};
use rigless::machine::{Board, Target};
use rigless::mcu::{Mcu, Operate};
use rigless::snapshot::Store;
use rigless::soc::Error;
use tenax_hal_shim::channel::CODE_MAX;

use super::Models;
use super::flash::MemoryMap;
use super::line::Line;
use super::part::Part;

pub const HSE_HZ: u64 = 8_000_000;
const SUPPLY_MV: u32 = 3_300;
const CLOCK_HZ: NonZeroU64 = NonZeroU64::new(100_000_000).expect("not zero");
const REFCLK_DIVIDER: NonZeroU32 = NonZeroU32::new(8).expect("not zero");
/// Interrupt priority bits (RM0383, section 10.1).
const PRIORITY_BITS: u8 = 4;
#[derive(Debug)]
pub struct Nucleo {
    pub mcu: Part,
    memory: MemoryMap,
    instructions_per_second: NonZeroU64,
    mpu: MpuRegions,
}

impl Nucleo {
    /// The board out of its box, its serial line in the hands of `line`.
    pub fn new(models: Models, instructions_per_second: NonZeroU64, line: Line) -> Result<Self, Error> {
        let mut mcu = Part::new(models, line)?;
        let memory = MemoryMap::new(&mcu)?;
        mcu.chip.rcc.attach_crystals(HSE_HZ, 0);
        mcu.chip.set_supply(SUPPLY_MV);
        // The model's word is `input * 4095 / reference`: with this reference, an input is a code and nothing is rounded.
        mcu.chip.adc[0].set_reference(u32::from(CODE_MAX));
        // With regions on, the emulator links no block of code to the next and looks up every access: 2.7 times as long.
        let mpu = match models {
            Models::Quick => MpuRegions::None,
            Models::Rigless => MpuRegions::Eight,
        };
        Ok(Self { mcu, memory, instructions_per_second, mpu })
    }
}

impl Store for Nucleo {}

impl Board for Nucleo {
    fn name(&self) -> &'static str {
        "nucleo-f411re"
    }

    fn target_names(&self) -> Vec<&'static str> {
        vec!["stm32f411re"]
    }

    fn mcu(&mut self, target: usize) -> Option<&mut dyn Mcu> {
        (target == 0).then_some(&mut self.mcu)
    }

    fn targets(&mut self) -> Vec<Target<'_>> {
        let lines = u32::from(Operate::cpu(&self.mcu).interrupt_lines);
        let core = Core {
            variant: Variant::M4,
            clock_hz: CLOCK_HZ,
            interrupt_lines: NonZeroU32::new(lines).expect("the chip has interrupts"),
            priority_bits: PRIORITY_BITS,
            refclk_divider: REFCLK_DIVIDER,
            instructions_per_second: self.instructions_per_second,
            boot: "flash",
        }
        .spec_with_parts(&windows(Mcu::bus(&self.mcu)), Fpu::FpV4Sp, self.mpu);
        // The emulator takes its memories from here, and everything else from `mcu`.
        vec![Target::new("stm32f411re", &mut self.memory, core)]
    }
}
