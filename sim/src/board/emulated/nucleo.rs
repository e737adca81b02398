//! The NUCLEO-F411RE as the emulator sees it: `rigless`'s STM32F427, which has every peripheral of the F411 at the same address, with
//! the F411's memories. There is no MPU: with its regions on, every access is looked up, which takes 2.7 times as long.

use std::num::{NonZeroU32, NonZeroU64};

use rigless::cpu::armv7m::windows;
use rigless::machine::armv7m::{Core, Fpu, MpuRegions, Variant};
use rigless::machine::{Board, Target};
use rigless::mcu::{Mcu, Operate};
use rigless::snapshot::Store;
use rigless::soc::stm32f427::Stm32f427;
use rigless::soc::stm32f427::generated::rcc::{Register, csr};
use rigless::soc::{Error, Width};
use rigless::time::VirtualNanos;
use tenax_hal_shim::channel::CODE_MAX;

use super::Options;
use super::flash::{MemoryMap, OPTCR, OPTKEYR};
use super::line::Line;

const HSE_HZ: u64 = 8_000_000;
const CLOCK_HZ: NonZeroU64 = NonZeroU64::new(100_000_000).expect("not zero");
const REFCLK_DIVIDER: NonZeroU32 = NonZeroU32::new(8).expect("not zero");
/// Interrupt priority bits (RM0383, section 10.1).
const PRIORITY_BITS: u8 = 4;
/// Option bytes as delivered but for the brown-out level, unlocked, and the keys; bit 1 programs them (RM0383, section 3.8).
const OPTIONS: u64 = 0x0FFF_AAE0;
const OPTION_KEYS: [u64; 2] = [0x0819_2A3B, 0x4C5D_6E7F];
const RCC_CIR: u64 = 0x4002_380C;
const TIM3_CNT: u64 = 0x4000_0424;
/// The serial port of the ST-LINK, USART2, in the order of the chip's ports.
pub const USART2: usize = 1;
/// TIM3, in the order of the chip's general timers.
const TIM3: usize = 1;

#[derive(Debug)]
pub struct Nucleo {
    pub chip: Stm32f427,
    memory: MemoryMap,
    instructions_per_second: NonZeroU64,
}

impl Nucleo {
    pub fn new(options: &Options) -> Result<Self, Error> {
        let mut chip = Stm32f427::new()?;
        chip.usart[USART2].attach(Line::default());
        chip.rcc.attach_crystals(HSE_HZ, 0);
        chip.set_supply(options.supply_mv);
        // The model's word is `input * 4095 / reference`: with this reference, an input is a code and nothing is rounded.
        chip.adc[0].set_reference(u32::from(CODE_MAX));
        let (memory, instructions_per_second) = (MemoryMap::new(&chip)?, options.instructions_per_second);
        let mut board = Self { memory, chip, instructions_per_second };
        let options = OPTIONS | u64::from(options.brown_out_level) << 2;
        let unlocks = OPTION_KEYS.map(|key| (OPTKEYR, key));
        for (register, value) in unlocks.into_iter().chain([(OPTCR, options), (OPTCR, options | 1 << 1)]) {
            board.poke(VirtualNanos(0), register, value);
        }
        Ok(board)
    }

    /// A register as it stands, 0 if it is none.
    pub fn peek(&mut self, now: VirtualNanos, address: u64) -> u64 {
        self.chip.peek(now, address, Width::W32).unwrap_or(0)
    }

    pub fn poke(&mut self, now: VirtualNanos, address: u64, value: u64) {
        let written = self.chip.write(now, address, Width::W32, value);
        debug_assert!(written.is_ok(), "{address:#x} is a register of the chip");
    }

    pub fn line(&mut self) -> Option<&mut Line> {
        self.chip.usart[USART2].chip_mut::<Line>()
    }

    /// How many pulses the scan's timer, TIM3, has sent on its TRGO.
    pub fn trigger_pulses(&mut self, now: VirtualNanos) -> u64 {
        // The timer's model catches up on what is due when it is read.
        let _ = self.chip.read(now, TIM3_CNT, Width::W32);
        self.chip.tim[TIM3].trigger_output().1
    }

    /// Time since the scan's last pulse, ns.
    pub fn since_pulse_ns(&mut self, now: VirtualNanos) -> u64 {
        self.peek(now, TIM3_CNT) * 10
    }

    /// The reset that was the pin's was a brown-out's: its flag stands beside (RM0383, section 6.3.20). `rigless` draws no supply.
    pub fn browned_out(&mut self, now: VirtualNanos) {
        if let Ok(slot) = self.chip.bus().slot("RCC") {
            let (registers, _) = self.chip.bus_mut().drive(now, slot);
            registers.set(Register::Csr, registers.get(Register::Csr) | csr::BORRSTF.mask());
        }
        // Any write lets the model take its registers up: the start of the watchdog's oscillator would put back the flags it knows.
        self.poke(now, RCC_CIR, 0);
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
        (target == 0).then_some(&mut self.chip)
    }

    fn targets(&mut self) -> Vec<Target<'_>> {
        let lines = u32::from(Operate::cpu(&self.chip).interrupt_lines);
        let core = Core {
            variant: Variant::M4,
            clock_hz: CLOCK_HZ,
            interrupt_lines: NonZeroU32::new(lines).expect("the chip has interrupts"),
            priority_bits: PRIORITY_BITS,
            refclk_divider: REFCLK_DIVIDER,
            instructions_per_second: self.instructions_per_second,
            boot: "flash",
        }
        .spec_with_parts(&windows(Mcu::bus(&self.chip)), Fpu::FpV4Sp, MpuRegions::None);
        // The emulator takes its memories from here, and everything else from `mcu`.
        vec![Target::new("stm32f411re", &mut self.memory, core)]
    }
}
