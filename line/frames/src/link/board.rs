//! A board that is opened again wherever it is plugged in: it is its chip, not its port.

use std::time::Duration;

use anyhow::anyhow;
use serialport::SerialPortType;
use tenax_hal_shim::wire::{Answer, Down};

use super::{Client, Target};

/// Vendor id of the board's ST-LINK.
const ST: u16 = 0x0483;
const ANSWER_WITHIN: Duration = Duration::from_millis(600);

/// A chip's unique number.
pub type Chip = [u32; 3];

#[derive(Clone, Debug)]
pub struct Board {
    pub line: Target,
    /// None: not known yet, or a host's own build, which has no chip.
    pub chip: Option<Chip>,
    /// Ports at which it may be plugged in instead.
    pub ports: fn() -> Vec<String>,
}

impl Board {
    pub const fn at(line: Target) -> Self {
        Self { line, chip: None, ports: plugged_in }
    }

    /// Opens its line, and what to say where it has moved. Fails if it is at no port.
    pub fn open(&mut self) -> anyhow::Result<(Client, Option<String>)> {
        let mut places = vec![self.line.clone()];
        if let Target::Port(own) = &self.line
            && self.chip.is_some()
        {
            places.extend((self.ports)().into_iter().filter(|port| port != own).map(Target::Port));
        }
        let mut why = None;
        for place in places {
            match self.try_at(&place) {
                Ok(client) => {
                    let moved = (place != self.line).then(|| {
                        format!("chip {} was at {}, and is at {place} now", self.chip_words(), self.line)
                    });
                    self.line = place;
                    return Ok((client, moved));
                }
                Err(error) => _ = why.get_or_insert(error),
            }
        }
        Err(why.unwrap_or_else(|| anyhow!("no port")))
    }

    fn try_at(&mut self, place: &Target) -> anyhow::Result<Client> {
        let mut client = Client::open(place)?;
        if !client.can_send() {
            return Ok(client);
        }
        let found = match client.ask(&Down::About, ANSWER_WITHIN) {
            Ok(Answer::About(about)) => Some(about.identity.chip).filter(|chip| *chip != [0; 3]),
            _ => None,
        };
        match (self.chip, found) {
            (Some(own), other) if other != Some(own) => Err(anyhow!(
                "{place} is {}, and not chip {}",
                other.map_or("no board that says its chip".to_owned(), |chip| format!("chip {}", hex(chip))),
                hex(own)
            )),
            _ => {
                self.chip = found;
                Ok(client)
            }
        }
    }

    /// `000000000000000000000000` where it is not known.
    pub fn chip_words(&self) -> String {
        hex(self.chip.unwrap_or_default())
    }
}

fn hex(chip: Chip) -> String {
    chip.map(|part| format!("{part:08x}")).concat()
}

/// The chip that [`Board::chip_words`] writes so.
pub fn chip_of(words: &str) -> Option<Chip> {
    let all = u128::from_str_radix(words, 16).ok().filter(|_| words.len() == 24)?;
    Some([64, 32, 0].map(|shift| (all >> shift) as u32))
}

/// Ports of the boards that are plugged in, each once.
pub fn plugged_in() -> Vec<String> {
    let ports = serialport::available_ports().unwrap_or_default();
    let is_board = |kind: &SerialPortType| matches!(kind, SerialPortType::UsbPort(usb) if usb.vid == ST);
    let boards = ports.into_iter().filter(|port| is_board(&port.port_type)).map(|port| port.port_name);
    one_each(boards.collect())
}

/// macOS lists a board as a terminal (tty.) and as a call-out device (cu.), which does not wait for a carrier.
fn one_each(mut ports: Vec<String>) -> Vec<String> {
    let all = ports.clone();
    ports.retain(|port| !all.contains(&port.replacen("/dev/tty.", "/dev/cu.", 1)) || !port.contains("/tty."));
    ports
}

#[cfg(test)]
mod tests {
    use super::{chip_of, hex, one_each};

    #[test]
    fn a_board_that_macos_lists_twice_is_one_and_a_chip_is_read_as_written() {
        let ports = ["/dev/cu.usbmodem1", "/dev/tty.usbmodem1", "/dev/tty.usbmodem2", "/dev/ttyACM0"];
        let expected = ["/dev/cu.usbmodem1", "/dev/tty.usbmodem2", "/dev/ttyACM0"];
        assert_eq!(one_each(ports.map(str::to_owned).to_vec()), expected);
        let chip = [0x0039_0042, 0x3231_5104, 0xffff_0001];
        assert_eq!(chip_of(&hex(chip)), Some(chip));
        assert_eq!((chip_of("39"), chip_of("00390042323151040000000g")), (None, None));
    }
}
