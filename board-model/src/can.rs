//! CAN1 as far as a chip that only sends needs it: `rigless` does not draw it, so its registers would hold what is written and
//! acknowledge nothing.
//!
//! It goes into its initialisation and out of it when it is asked, and sends what is put into a mailbox at once. Where nobody listens, no
//! frame is acknowledged: it stays in its mailbox until it is given up. No arbitration, no time on the wires, no errors that are counted,
//! nothing received (RM0390, chapter bxCAN; RM0090, chapter 32).

use rigless::device::{DeviceContext, ErasedDevice, RegisterFile, RequestChange};
use rigless::soc::stm32f427::generated::can1::{Register, mcr, msr, tsr};
use rigless::soc::{Layout, RegisterSpec};
use rigless::time::{EventId, VirtualNanos};

const MAILBOXES: usize = 3;
/// Registers of a mailbox, from its identifier's on.
const MAILBOX_ROWS: usize = 4;
const TXRQ: u64 = 1;
const RTR: u64 = 1 << 1;
const IDE: u64 = 1 << 2;
/// What a mailbox that has sent its frame says: request completed, transmission OK.
const SENT: u64 = 0b11;
const GIVEN_UP: u64 = 0b01;
/// Bits of TSR that each mailbox has, and where its demand to give up stands among them.
const MAILBOX_BITS: u64 = 8;
const ABRQ: u64 = 1 << 7;
const MAILBOX_MASK: u64 = 0x0F;
const EMPTY_SHIFT: u64 = 26;

/// A frame that was sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sent {
    /// When it was put into its mailbox.
    pub at: VirtualNanos,
    /// Of 29 bits.
    pub identifier: u32,
    /// Its eight bytes.
    pub bytes: [u8; 8],
}

/// The port, and what went out of it.
#[derive(Debug, Default)]
pub struct Can {
    /// Every frame that was acknowledged.
    pub sent: Vec<Sent>,
    /// Nobody is there to acknowledge one.
    pub is_alone: bool,
    /// Frames that were given up.
    pub given_up: u64,
    /// Mailboxes that have a frame, and what TSR says of each.
    full: [bool; MAILBOXES],
    said: u64,
}

impl Can {
    /// As a reset of the chip leaves it. What was sent was heard.
    pub fn restarted(&mut self) {
        *self = Self { sent: std::mem::take(&mut self.sent), is_alone: self.is_alone, ..Self::default() };
    }

    /// What MSR and TSR read, as MCR stands: it does at once what it is asked for.
    fn status(&self, row: usize, registers: &RegisterFile) -> Option<u64> {
        let asked = registers.get(Register::Mcr);
        if row == Register::Msr as usize {
            let (sleeps, begins) = (mcr::SLEEP.is_set(asked), mcr::INRQ.is_set(asked));
            let acknowledged = |field: u64, is_set: bool| if is_set { field } else { 0 };
            // A request to initialise ends its sleep only together with the other bit.
            let found = acknowledged(msr::SLAK.mask(), sleeps);
            return Some(found | acknowledged(msr::INAK.mask(), begins && !sleeps));
        }
        (row == Register::Tsr as usize).then(|| {
            let empty = (0..MAILBOXES).filter(|&n| !self.full[n]).map(|n| 1 << (EMPTY_SHIFT + n as u64));
            self.said | empty.sum::<u64>()
        })
    }

    fn says(&mut self, mailbox: usize, what: u64) {
        let shift = mailbox as u64 * MAILBOX_BITS;
        self.said = self.said & !(MAILBOX_MASK << shift) | what << shift;
    }

    fn asked_to_send(&mut self, mailbox: usize, registers: &RegisterFile, now: VirtualNanos) {
        let row = |n: usize| registers.get(Register::ALL[first_row(mailbox) + n]);
        let [identifier, length, low, high] = [row(0), row(1), row(2), row(3)];
        assert!(
            identifier & (IDE | RTR) == IDE && length == 8,
            "not a fingertip's: {identifier:#x} {length}"
        );
        let mcr = registers.get(Register::Mcr);
        assert!(!mcr::INRQ.is_set(mcr) && !mcr::SLEEP.is_set(mcr), "it does not take part in the bus");
        assert!(!self.full[mailbox], "mailbox {mailbox} is not empty");
        self.says(mailbox, 0);
        if self.is_alone {
            self.full[mailbox] = true;
            return;
        }
        let bytes = (low | high << 32).to_le_bytes();
        self.sent.push(Sent { at: now, identifier: (identifier >> 3) as u32, bytes });
        self.says(mailbox, SENT);
    }
}

const fn first_row(mailbox: usize) -> usize {
    Register::Ti0r as usize + MAILBOX_ROWS * mailbox
}

impl ErasedDevice for Can {
    fn layout(&self) -> &'static [RegisterSpec] {
        Register::REGISTERS
    }

    fn read(
        &mut self,
        row: usize,
        registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) -> Option<u64> {
        self.peek(row, registers, context.now())
    }

    fn peek(&self, row: usize, registers: &RegisterFile, _now: VirtualNanos) -> Option<u64> {
        self.status(row, registers)
    }

    fn write(
        &mut self,
        row: usize,
        value: u64,
        registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) {
        for mailbox in 0..MAILBOXES {
            if row == first_row(mailbox) && value & TXRQ != 0 {
                self.asked_to_send(mailbox, registers, context.now());
            }
            let demands = value >> (mailbox as u64 * MAILBOX_BITS);
            if row == Register::Tsr as usize {
                if demands & tsr::RQCP0.mask() != 0 {
                    self.says(mailbox, 0);
                }
                if demands & ABRQ != 0 && std::mem::take(&mut self.full[mailbox]) {
                    self.given_up += 1;
                    self.says(mailbox, GIVEN_UP);
                }
            }
        }
    }

    fn reset(&mut self) {
        self.restarted();
    }

    fn on_event(&mut self, _: EventId, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_request(&mut self, _: RequestChange, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_clock(&mut self, _: u64, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn poll(&mut self, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_access(&mut self, _: u64, _: u64, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}

    fn on_refused(&mut self, _: u64, _: &mut RegisterFile, _: &mut DeviceContext<'_>) {}
}

#[cfg(test)]
mod tests {
    use rigless::mcu::Operate;
    use rigless::soc::Width;
    use rigless::time::VirtualNanos;

    use crate::Models;
    use crate::line::Line;
    use crate::part::Part;

    const MCR: u64 = 0x4000_6400;
    const MSR: u64 = 0x4000_6404;
    const TSR: u64 = 0x4000_6408;
    const MAILBOX: [u64; 3] = [0x4000_6580, 0x4000_6590, 0x4000_65A0];
    const NOW: VirtualNanos = VirtualNanos(1_000);

    fn read(part: &mut Part, address: u64) -> u64 {
        part.read(NOW, address, Width::W32).expect("a register")
    }

    fn write(part: &mut Part, address: u64, value: u64) {
        part.write(NOW, address, Width::W32, value).expect("a register");
    }

    fn send(part: &mut Part, mailbox: usize, identifier: u64) {
        for (offset, value) in [(4, 8), (8, 0x0403_0201), (12, 0x0807_0605), (0, identifier << 3 | 0b101)] {
            write(part, MAILBOX[mailbox] + offset, value);
        }
    }

    /// As RM0390 has it: asleep out of reset, ready to be set up when it is asked, then a mailbox is sent, or stays full until it is given up.
    #[test]
    fn it_wakes_sends_and_gives_up() {
        let mut part = Part::new(Models::Quick, Line::default()).expect("the chip");
        assert_eq!((read(&mut part, MSR) & 0b11, read(&mut part, TSR)), (0b10, 0x1C00_0000));
        write(&mut part, MCR, 1);
        assert_eq!(read(&mut part, MSR) & 0b11, 0b01);
        write(&mut part, MCR, 1 << 6);
        assert_eq!(read(&mut part, MSR) & 0b11, 0);
        send(&mut part, 1, 0x1234_5678);
        assert_eq!(read(&mut part, TSR), 0x1C00_0300);
        let can = part.can().expect("a model");
        let sent: Vec<_> = can.sent.drain(..).map(|sent| (sent.identifier, sent.bytes)).collect();
        assert_eq!(sent, [(0x1234_5678, [1, 2, 3, 4, 5, 6, 7, 8])]);
        can.is_alone = true;
        send(&mut part, 0, 1);
        assert_eq!(read(&mut part, TSR), 0x1800_0300);
        write(&mut part, TSR, 1 << 7);
        assert_eq!(read(&mut part, TSR), 0x1C00_0301);
        let can = part.can().expect("a model");
        assert_eq!((can.sent.len(), can.given_up), (0, 1));
    }
}
