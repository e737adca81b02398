//! The option `--port`, and the only board that is plugged in, where none is named.

use anyhow::bail;
use serialport::SerialPortType;
use tenax_frames::link::{Client, Target, port_names};

/// Vendor id of the board's ST-LINK.
const ST: u16 = 0x0483;

#[derive(Debug, clap::Args)]
pub struct Line {
    /// Serial line: /dev/ttyACM0, COM3, /dev/pts/5 or tcp:127.0.0.1:7777 [default: the only board that is plugged in]
    #[arg(long, value_name = "PORT", global = true)]
    pub port: Option<Target>,
}

impl Line {
    pub fn open(&self) -> anyhow::Result<Client> {
        Client::open(&or_found(self.port.as_ref())?)
    }
}

/// The line that was named, or that of the only board. Fails if there is none or there are several: names the ports.
pub fn or_found(named: Option<&Target>) -> anyhow::Result<Target> {
    if let Some(target) = named {
        return Ok(target.clone());
    }
    let ports = serialport::available_ports().unwrap_or_default();
    let is_board = |kind: &SerialPortType| matches!(kind, SerialPortType::UsbPort(usb) if usb.vid == ST);
    let boards = ports.iter().filter(|port| is_board(&port.port_type)).map(|port| port.port_name.as_str());
    let boards = one_each(boards.collect());
    match boards[..] {
        [only] => Ok(Target::Port(only.to_owned())),
        [] => bail!(
            "no board is plugged in; serial ports on this machine: {}. Name one with --port, or a scene's line, which \
             `tenax run --serve` prints",
            port_names()
        ),
        _ => bail!("several boards are plugged in: name one with --port: {}", boards.join(", ")),
    }
}

/// Each board once: macOS lists it as a terminal (tty.) and as a call-out device (cu.), which does not wait for a carrier.
fn one_each(mut ports: Vec<&str>) -> Vec<&str> {
    let all = ports.clone();
    ports.retain(|port| {
        !all.contains(&port.replacen("/dev/tty.", "/dev/cu.", 1).as_str()) || !port.contains("/tty.")
    });
    ports
}

#[cfg(test)]
mod tests {
    use super::one_each;

    #[test]
    fn a_board_that_macos_lists_twice_is_one() {
        let ports = ["/dev/cu.usbmodem1", "/dev/tty.usbmodem1", "/dev/tty.usbmodem2", "/dev/ttyACM0"];
        assert_eq!(one_each(ports.to_vec()), ["/dev/cu.usbmodem1", "/dev/tty.usbmodem2", "/dev/ttyACM0"]);
    }
}
