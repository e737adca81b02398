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
use super::serial_path::{self, SerialPath};
use super::unwatched::UnwatchedTimer;

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

/// What takes the place of some of them.
#[derive(Debug)]
struct Own {
    scan: ScanPath,
    timer: UnwatchedTimer,
    bridge: BridgeTimer,
    serial: SerialPath,
    scan_controller: usize,
    port: usize,
    answers: Box<[Answers]>,
}

/// Who answers for a slot of the bus.
#[derive(Clone, Copy, Debug)]
enum Answers {
    Chip,
    Scan(scan_path::Asked),
    ScanTimer,
    BridgeTimer,
    Serial(serial_path::Asked),
    /// The vibration motor's timer: the registers hold what is written to them, and nothing happens.
    RegistersAlone,
}

impl Own {
    fn new(bus: &Bus, line: Line) -> Result<Self, Error> {
        let mut answers = vec![Answers::Chip; bus.slots().len()].into_boxed_slice();
        let [scan_controller, port] = [bus.slot("DMA2")?, bus.slot("USART2")?];
        answers[scan_controller] = Answers::Scan(scan_path::Asked::Controller);
        answers[bus.slot("ADC1")?] = Answers::Scan(scan_path::Asked::Converter);
        answers[bus.slot("TIM3")?] = Answers::ScanTimer;
        answers[port] = Answers::Serial(serial_path::Asked::Port);
        answers[bus.slot("DMA1")?] = Answers::Serial(serial_path::Asked::Controller);
        answers[bus.slot("TIM1")?] = Answers::BridgeTimer;
        answers[bus.slot("TIM4")?] = Answers::RegistersAlone;
        Ok(Self {
            scan: ScanPath::new(),
            timer: UnwatchedTimer::new(TIM3)?,
            bridge: BridgeTimer::default(),
            serial: SerialPath::new(Some(line))?,
            scan_controller,
            port,
            answers,
        })
    }
}

impl Part {
    /// A chip out of reset, `line` at the far end of its serial port.
    pub fn new(models: Models, line: Line) -> Result<Self, Error> {
        let mut chip = Stm32f427::new()?;
        let own = match models {
            Models::Quick => Some(Own::new(chip.bus(), line)?),
            Models::Rigless => {
                chip.usart[USART2].attach(line);
                None
            }
        };
        Ok(Self { chip, own })
    }

    /// Puts codes on pins of the converter, from now on.
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

    /// The far end of the serial line, as it is now.
    pub fn line(&mut self, now: VirtualNanos) -> Option<&mut Line> {
        let Self { chip, own } = self;
        match own {
            Some(own) => {
                let (_, mut context) = chip.bus_mut().drive(now, own.port);
                own.serial.line(&mut context)
            }
            None => chip.usart[USART2].chip_mut::<Line>(),
        }
    }

    /// How many pulses the scan's timer, TIM3, has sent on its TRGO.
    pub fn trigger_pulses(&mut self, now: VirtualNanos) -> u64 {
        match &mut self.own {
            Some(own) => own.timer.trigger_pulses(now),
            None => {
                // The timer's model catches up on what is due when it is read.
                let _ = self.chip.read(now, TIM3_CNT, Width::W32);
                self.chip.tim[TIM3].trigger_output().1
            }
        }
    }

    /// How long ago the last of them was, ns.
    pub fn since_pulse_ns(&mut self, now: VirtualNanos) -> u64 {
        match &mut self.own {
            Some(own) => own.timer.since_pulse_ns(now),
            None => self.chip.peek(now, TIM3_CNT, Width::W32).unwrap_or(0) * 10,
        }
    }

    /// The reset that was the pin's was a brown-out's: its flag stands beside (RM0383, section 6.3.20). `rigless` draws no supply.
    pub fn browned_out(&mut self, now: VirtualNanos) {
        if let Ok(slot) = self.chip.bus().slot("RCC") {
            let (registers, _) = self.chip.bus_mut().drive(now, slot);
            registers.set(Register::Csr, registers.get(Register::Csr) | csr::BORRSTF.mask());
        }
    }

    /// A trigger that the converter listens to arrives.
    pub fn trigger(&mut self, now: VirtualNanos) {
        let Self { chip, own } = self;
        match own {
            Some(own) => {
                let (registers, mut context) = chip.bus_mut().drive(now, own.scan_controller);
                own.scan.trigger(registers, &mut context);
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
            own.timer.restarted();
            own.bridge = BridgeTimer::default();
            own.serial.restarted(at);
        }
    }

    /// Only the serial port has a far end.
    fn poll(&mut self, now: VirtualNanos) {
        let Self { chip, own } = self;
        match own {
            Some(own) => {
                let (_, mut context) = chip.bus_mut().drive(now, own.port);
                own.serial.look(&mut context);
            }
            None => chip.poll(now),
        }
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
            Answers::Serial(asked) => (chip.bus_mut(), Some(own.serial.of(asked))),
            Answers::ScanTimer => (chip.bus_mut(), Some(&mut own.timer)),
            Answers::BridgeTimer => (chip.bus_mut(), Some(&mut own.bridge)),
            Answers::RegistersAlone => (chip.bus_mut(), None),
        }
    }
}
