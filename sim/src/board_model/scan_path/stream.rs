//! The DMA stream that carries the converter's codes into a ring: stream 0 of DMA2 (RM0383, chapter 9).

use rigless::device::{DeviceContext, Level, RegisterFile};
use rigless::soc::Width;
use rigless::soc::stm32f427::generated::dma2::{Register, lisr, s0cr, s0ndtr};

const RAM: std::ops::Range<u64> = 0x2000_0000..0x2002_0000;
const CODE_BYTES: u64 = 2;
const LINE: usize = 0;

#[derive(Debug)]
pub struct Stream {
    ring: Option<Ring>,
    programmed: u64,
    flags: u64,
    interrupt: Level,
    begun: u64,
    taken: Vec<u16>,
    taken_at: u64,
}

#[derive(Clone, Copy, Debug)]
struct Ring {
    begins: u64,
    length: u64,
    left: u64,
}

impl Ring {
    fn to_flag(self) -> u64 {
        let filled = self.length - self.left;
        let half = self.length.div_ceil(2);
        if filled < half { half - filled } else { self.left }
    }

    fn is_in_memory(self) -> bool {
        RAM.contains(&self.begins) && self.begins + CODE_BYTES * self.length <= RAM.end
    }
}

impl Stream {
    pub fn new() -> Self {
        Self {
            ring: None,
            programmed: 0,
            flags: 0,
            interrupt: Level::Low,
            begun: 0,
            taken: Vec::new(),
            taken_at: 0,
        }
    }

    pub fn reset(&mut self) {
        *self = Self { begun: self.begun, ..Self::new() };
    }

    pub fn shows(&self, row: usize) -> Option<u64> {
        match row {
            _ if row == Register::Lisr as usize => Some(self.flags),
            _ if row == Register::S0ndtr as usize => self.ring.map(|ring| ring.left),
            _ => None,
        }
    }

    /// How many codes it takes before something is to be seen of it from outside, at least one. None while it is off.
    pub fn patience(&self) -> Option<u64> {
        self.ring.map(|ring| if ring.is_in_memory() { ring.to_flag().max(1) } else { 1 })
    }

    pub fn take(&mut self, code: impl FnOnce() -> u16, context: &mut DeviceContext<'_>) {
        let Some(ring) = self.ring.as_mut().filter(|ring| ring.left > 0) else {
            return;
        };
        if self.taken.is_empty() {
            self.taken_at = ring.begins + CODE_BYTES * (ring.length - ring.left);
        }
        self.taken.push(code());
        if ring.to_flag() == 1 {
            let whole = ring.left == 1;
            self.flags |= if whole { lisr::TCIF0.mask() } else { lisr::HTIF0.mask() };
        }
        ring.left -= 1;
        if ring.left == 0 {
            ring.left = ring.length;
            self.put(context);
        }
    }

    pub fn put(&mut self, context: &mut DeviceContext<'_>) {
        let mut codes = self.taken.as_slice();
        while !codes.is_empty() {
            let (width, count) = match codes.len() {
                4.. => (Width::W64, 4),
                2.. => (Width::W32, 2),
                _ => (Width::W16, 1),
            };
            let (now, later) = codes.split_at(count);
            let value = now.iter().rev().fold(0, |value, &code| value << 16 | u64::from(code));
            context.write_to(self.taken_at, width, value, self.begun);
            self.taken_at += u64::from(width.bytes());
            codes = later;
        }
        self.taken.clear();
    }

    pub fn refused(&mut self, token: u64, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        if token == self.begun && self.ring.is_some() {
            self.flags |= lisr::TEIF0.mask();
            self.switch_off(registers);
            self.settle(registers, context);
        }
    }

    /// The core has written a register of the controller. The flags up to now must be known.
    ///
    /// # Panics
    /// If it asks for what this model does not know.
    pub fn written(
        &mut self,
        row: usize,
        written: u64,
        registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) {
        match row {
            _ if row == Register::Lifcr as usize => {
                self.flags &= !written;
                registers.set(Register::Lifcr, 0);
            }
            _ if row == Register::Hifcr as usize => registers.set(Register::Hifcr, 0),
            _ if row == Register::S0cr as usize => {
                match (self.ring.is_some(), s0cr::EN.is_set(registers.get(Register::S0cr))) {
                    (false, true) => self.switch_on(registers),
                    (true, false) => {
                        // What is switched off has ended (RM0383, section 9.3.14).
                        self.flags |= lisr::TCIF0.mask();
                        self.switch_off(registers);
                    }
                    _ => {}
                }
            }
            _ if row == Register::S0ndtr as usize => {
                self.programmed = s0ndtr::NDT.get(registers.get(Register::S0ndtr));
            }
            _ => {}
        }
        self.settle(registers, context);
    }

    pub fn settle(&mut self, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        if let Some(ring) = self.ring {
            registers.set(Register::S0ndtr, ring.left);
        }
        registers.set(Register::Lisr, self.flags);
        let control = registers.get(Register::S0cr);
        let enabled = |enable: u64, flag: u64| control & enable != 0 && self.flags & flag != 0;
        let level = Level::from(
            enabled(s0cr::TEIE.mask(), lisr::TEIF0.mask())
                || enabled(s0cr::HTIE.mask(), lisr::HTIF0.mask())
                || enabled(s0cr::TCIE.mask(), lisr::TCIF0.mask()),
        );
        if level != self.interrupt {
            self.interrupt = level;
            context.interrupt(LINE, level);
        }
    }

    fn switch_on(&mut self, registers: &mut RegisterFile) {
        let control = registers.get(Register::S0cr);
        let [from_peripheral, half_words, adc1] =
            [s0cr::DIR.get(control), s0cr::PSIZE.get(control), s0cr::CHSEL.get(control)];
        assert!(
            (from_peripheral, half_words, adc1) == (0, 1, 0)
                && control & (s0cr::PINC.mask() | s0cr::DBM.mask() | s0cr::PFCTRL.mask()) == 0
                && s0cr::CIRC.is_set(control)
                && s0cr::MINC.is_set(control),
            "the scan's DMA carries ADC1's codes into a ring and nothing else: {control:#x}"
        );
        self.begun += 1;
        self.ring = Some(Ring {
            begins: registers.get(Register::S0m0ar),
            length: self.programmed,
            left: self.programmed,
        });
    }

    fn switch_off(&mut self, registers: &mut RegisterFile) {
        if let Some(ring) = self.ring.take() {
            registers.set(Register::S0ndtr, ring.left);
        }
        registers.set(Register::S0cr, registers.get(Register::S0cr) & !s0cr::EN.mask());
    }
}
