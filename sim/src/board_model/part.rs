//! The chip: `rigless`'s peripherals, less the events that nobody sees.

use rigless::device::{ErasedDevice, ResetCause};
use rigless::mcu::{Mcu, Operate};
use rigless::soc::stm32f427::Stm32f427;
use rigless::soc::stm32f427::generated::rcc::{Register, csr};
use rigless::soc::stm32f427::peripherals::adc::Channel;
use rigless::soc::{Bus, Error, Width};
use rigless::time::VirtualNanos;

use super::Models;
use super::bridge_timer::BridgeTimer;
use super::line::Line;
use super::scan_path::{self, ScanPath};

const ADC1_CR2: u64 = 0x4001_2008;
const CR2_SWSTART: u64 = 1 << 30;
const TIM3_CNT: u64 = 0x4000_0424;
/// The serial port of the ST-LINK, USART2, in the order of the chip's ports.
const USART2: usize = 1;
/// TIM3, in the order of the chip's general timers.
const TIM3: usize = 1;

/// An STM32F427, whose peripherals contain the F411's.
#[derive(Debug)]
pub struct Part {
    /// `rigless`'s own models.
    pub chip: Stm32f427,
    own: Option<Own>,
}

#[derive(Debug)]
struct Own {
    scan: ScanPath,
    bridge: BridgeTimer,
    scan_controller: usize,
    answers: Box<[Answers]>,
}

#[derive(Clone, Copy, Debug)]
enum Answers {
    Chip,
    Scan(scan_path::Asked),
    BridgeTimer,
    RegistersAlone,
}

impl Own {
    fn new(bus: &Bus) -> Result<Self, Error> {
        let mut answers = vec![Answers::Chip; bus.slots().len()].into_boxed_slice();
        let scan_controller = bus.slot("DMA2")?;
        answers[scan_controller] = Answers::Scan(scan_path::Asked::Controller);
        answers[bus.slot("ADC1")?] = Answers::Scan(scan_path::Asked::Converter);
        answers[bus.slot("TIM1")?] = Answers::BridgeTimer;
        answers[bus.slot("TIM4")?] = Answers::RegistersAlone;
        Ok(Self { scan: ScanPath::new()?, bridge: BridgeTimer::default(), scan_controller, answers })
    }
}

impl Part {
    /// A chip out of reset, `line` at the far end of its serial port.
    pub fn new(models: Models, line: Line) -> Result<Self, Error> {
        let mut chip = Stm32f427::new()?;
        chip.usart[USART2].attach(line);
        let own = match models {
            Models::Quick => Some(Own::new(chip.bus())?),
            Models::Rigless => None,
        };
        Ok(Self { chip, own })
    }

    pub fn put(&mut self, now: VirtualNanos, codes: impl IntoIterator<Item = (u8, u16)>) {
        let Self { chip, own } = self;
        match own {
            Some(own) => {
                let (_, mut context) = chip.bus_mut().drive(now, own.scan_controller);
                own.scan.put(codes, &mut context);
            }
            None => {
                for (channel, code) in codes {
                    let channel = Channel::new(channel).expect("the channel map has pin channels");
                    chip.adc[0].set_input(channel, u32::from(code));
                }
            }
        }
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

    pub fn since_pulse_ns(&mut self, now: VirtualNanos) -> u64 {
        self.chip.peek(now, TIM3_CNT, Width::W32).unwrap_or(0) * 10
    }

    /// The reset that was the pin's was a brown-out's: its flag stands beside (RM0383, section 6.3.20). `rigless` draws no supply.
    pub fn browned_out(&mut self, now: VirtualNanos) {
        if let Ok(slot) = self.chip.bus().slot("RCC") {
            let (registers, _) = self.chip.bus_mut().drive(now, slot);
            registers.set(Register::Csr, registers.get(Register::Csr) | csr::BORRSTF.mask());
        }
    }

    pub fn trigger(&mut self, now: VirtualNanos) {
        let Self { chip, own } = self;
        match own {
            Some(own) => {
                let (_, mut context) = chip.bus_mut().drive(now, own.scan_controller);
                own.scan.trigger(&mut context);
            }
            None => {
                let started = chip
                    .peek(now, ADC1_CR2, Width::W32)
                    .and_then(|cr2| chip.write(now, ADC1_CR2, Width::W32, cr2 | CR2_SWSTART));
                debug_assert!(started.is_ok(), "{ADC1_CR2:#x} is a register of the chip");
            }
        }
    }
}

impl Mcu for Part {
    fn bus(&self) -> &Bus {
        self.chip.bus()
    }

    fn bus_mut(&mut self) -> &mut Bus {
        self.chip.bus_mut()
    }

    fn reset(&mut self, at: VirtualNanos, cause: ResetCause) {
        self.chip.reset(at, cause);
        if let Some(own) = &mut self.own {
            own.scan.restarted();
            own.bridge = BridgeTimer::default();
        }
    }

    fn poll(&mut self, now: VirtualNanos) {
        self.chip.poll(now);
    }

    fn split(&mut self, slot: usize) -> (&mut Bus, Option<&mut dyn ErasedDevice>) {
        let Self { chip, own } = self;
        let Some(own) = own else {
            return chip.split(slot);
        };
        // A window that is added has a slot past the chip's own.
        match own.answers.get(slot).copied().unwrap_or(Answers::Chip) {
            Answers::Chip => chip.split(slot),
            Answers::Scan(asked) => (chip.bus_mut(), Some(own.scan.of(asked))),
            Answers::BridgeTimer => (chip.bus_mut(), Some(&mut own.bridge)),
            Answers::RegistersAlone => (chip.bus_mut(), None),
        }
    }
}
