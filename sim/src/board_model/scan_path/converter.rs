//! The converter as far as a scan by a trigger needs it: RM0383, chapter 11.

use rigless::soc::Layout;
use rigless::soc::stm32f427::generated::adc1::Register;
use rigless::soc::stm32f427::generated::adc1::{cr1, cr2, sqr1, sr};
use rigless::time::{Run, VirtualNanos};
use tenax_hal_shim::channel::CODE_MAX;

const RANKS: usize = 16;
const PINS: usize = 16;
const RESET_CLOCK_HZ: u64 = 8_000_000;
/// Cycles of sampling for each code of SMPx (RM0383, section 11.12.4), before the twelve of the conversion.
const SAMPLING_CYCLES: [u128; 8] = [3, 15, 28, 56, 84, 112, 144, 480];
const CONVERSION_CYCLES: u128 = 12;
const KEPT: usize = Register::Sqr3 as usize + 1;

#[derive(Debug)]
pub struct Converter {
    clock_hz: u64,
    inputs: [u16; PINS],
    registers: [u64; KEPT],
    status: u64,
    data: u16,
    unread: bool,
    sequence: Option<Sequence>,
    plan: Option<Plan>,
}

/// What a sequence converts, and when each conversion ends, ns after the trigger.
#[derive(Clone, Copy, Debug)]
struct Plan {
    channels: [u8; RANKS],
    ends_after_ns: [u64; RANKS],
    length: usize,
}

#[derive(Clone, Copy, Debug)]
struct Sequence {
    plan: Plan,
    began: VirtualNanos,
    next: usize,
}

impl Sequence {
    fn ends(&self, conversion: usize) -> VirtualNanos {
        VirtualNanos(self.began.0 + self.plan.ends_after_ns[conversion])
    }
}

impl Converter {
    pub fn new() -> Self {
        Self {
            clock_hz: RESET_CLOCK_HZ,
            inputs: [0; PINS],
            registers: std::array::from_fn(|row| Register::REGISTERS[row].reset),
            status: 0,
            data: 0,
            unread: false,
            sequence: None,
            plan: None,
        }
    }

    pub fn restarted(&mut self) {
        *self = Self { inputs: self.inputs, ..Self::new() };
    }

    pub fn reset(&mut self) {
        *self = Self { inputs: self.inputs, clock_hz: self.clock_hz, ..Self::new() };
    }

    pub fn clock(&mut self, hz: u64) {
        self.clock_hz = hz;
        self.plan = None;
    }

    pub fn put(&mut self, channel: u8, code: u16) {
        self.inputs[usize::from(channel)] = code.min(CODE_MAX);
    }

    pub fn shows(&self, row: usize) -> Option<u64> {
        match row {
            _ if row == Register::Sr as usize => Some(self.status),
            _ if row == Register::Dr as usize => Some(u64::from(self.data)),
            _ => None,
        }
    }

    pub fn taken(&mut self) -> u16 {
        self.status &= !sr::EOC.mask();
        self.unread = false;
        self.data
    }

    pub fn written(&mut self, row: usize, landed: u64) {
        if row == Register::Sr as usize {
            // Every flag is cleared by a written zero.
            self.status &= landed;
            self.unread &= self.status & sr::EOC.mask() != 0;
        } else if row < KEPT {
            self.registers[row] = landed;
            self.plan = None;
            if row == Register::Cr2 as usize && landed & cr2::ADON.mask() == 0 {
                self.sequence = None;
            }
        }
    }

    pub fn start(&mut self, now: VirtualNanos) {
        if self.status & sr::OVR.mask() != 0 || self.sequence.is_some() {
            return;
        }
        self.status |= sr::STRT.mask();
        if self.clock_hz == 0 {
            return;
        }
        let plan = *self.plan.get_or_insert_with(|| Plan::new(&self.registers, self.clock_hz));
        self.sequence = Some(Sequence { plan, began: now, next: 0 });
    }

    /// Ends the next conversion if it ends by `now`. None if there is no such.
    pub fn convert(&mut self, now: VirtualNanos) -> Option<()> {
        let sequence = self.sequence.as_mut().filter(|sequence| sequence.ends(sequence.next) <= now)?;
        if self.unread && self.registers[Register::Cr2 as usize] & cr2::DMA.mask() != 0 {
            self.status |= sr::OVR.mask();
            self.sequence = None;
            return Some(());
        }
        let channel = usize::from(sequence.plan.channels[sequence.next]);
        self.data = self.inputs.get(channel).copied().unwrap_or(0);
        self.unread = true;
        sequence.next += 1;
        if sequence.next == sequence.plan.length {
            self.status |= sr::EOC.mask();
            self.sequence = None;
        } else {
            // The next one begins.
            self.status |= sr::STRT.mask();
        }
        Some(())
    }

    pub fn requests(&self) -> bool {
        let by_dma = self.registers[Register::Cr2 as usize] & cr2::DMA.mask() != 0;
        by_dma && self.unread && self.status & sr::OVR.mask() == 0
    }

    /// When the `nth` conversion from now ends, if it is one of the sequence under way.
    pub fn ends(&self, nth: usize) -> Option<VirtualNanos> {
        let sequence = self.sequence.as_ref()?;
        let conversion = sequence.next + nth;
        (conversion < sequence.plan.length).then(|| sequence.ends(conversion))
    }
}

impl Plan {
    fn new(registers: &[u64; KEPT], clock_hz: u64) -> Self {
        let scans = registers[Register::Cr1 as usize] & cr1::SCAN.mask() != 0;
        let last = if scans { sqr1::L.get(registers[Register::Sqr1 as usize]) } else { 0 };
        // Five bits a rank, six ranks a register, the first ones in SQR3.
        let channels: [u8; RANKS] = std::array::from_fn(|rank| {
            (registers[Register::Sqr3 as usize - rank / 6] >> (5 * (rank % 6)) & 0x1F) as u8
        });
        // From where it began, so that what is left of a nanosecond does not add up.
        let mut run = Run::at(VirtualNanos(0));
        let ends_after_ns = channels.map(|channel| {
            let (register, index) = match channel {
                0..=9 => (Register::Smpr2, channel),
                _ => (Register::Smpr1, channel - 10),
            };
            let sampling = registers[register as usize] >> (3 * index) & 0b111;
            run.extend(SAMPLING_CYCLES[sampling as usize] + CONVERSION_CYCLES, clock_hz);
            run.ends.0
        });
        Self { channels, ends_after_ns, length: last as usize + 1 }
    }
}
