//! The kernels on a second core, that of QEMU's netduinoplus2 (an STM32F405): what both emulators say is not one's error.
//!
//! QEMU (Debian's `qemu-system-arm`) stops at breakpoints of its debugger's port, and tells on its control port how many instructions
//! it has executed.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::Shutdown;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};
use rigless::emulator::{Error, Memory};
use rigless::soc::Width;
use tenax_hal_shim::frame::Frame;
use tenax_logic::array::Reading;

use super::bench::Bench;
use super::meter::Meters;
use super::{Kernels, Outcome};
use crate::image::kernels::KernelSymbols;

/// How long it may take to answer.
const PATIENCE: Duration = Duration::from_secs(60);

/// [`run_frames`](super::run_frames) on QEMU. Fails if it cannot be started, or is silent for a minute.
pub fn run_frames(
    image: &Path,
    recordings: &[Vec<Reading>],
    frames: &[Frame],
    kernels: Kernels,
) -> Result<Outcome> {
    let symbols = KernelSymbols::read(image)?;
    let mut bench = Bench::new(&symbols, recordings, frames, kernels, mpsc::channel().0);
    let mut qemu = Qemu::start(image)?;
    for address in Meters::watched(&symbols.kernels).chain([symbols.next]) {
        qemu.order(&format!("Z0,{address:x},2"))?;
    }
    let mut at = qemu.arrive()?;
    while !bench.arrive(at, qemu.instructions()?, &mut qemu).context("QEMU's memory")? {
        // A breakpoint stops the core before its instruction, so it is taken away for one step.
        qemu.order(&format!("z0,{at:x},2"))?;
        qemu.ask("s")?;
        qemu.order(&format!("Z0,{at:x},2"))?;
        at = qemu.arrive()?;
    }
    Ok(bench.into_outcome())
}

struct Qemu {
    process: Child,
    debugger: BufReader<UnixStream>,
    control: BufReader<UnixStream>,
    /// A block of its memory, and where it begins, as long as the core stands.
    block: Option<(u64, Vec<u8>)>,
}

impl Qemu {
    fn start(image: &Path) -> Result<Self> {
        let ports = tempfile::tempdir()?;
        let port = |name: &str| ports.path().join(name);
        let server =
            |name: &str| format!("socket,id={name},path={},server=on,wait=off", port(name).display());
        let mut process = Command::new("qemu-system-arm")
            .args(["-machine", "netduinoplus2", "-icount", "shift=0", "-S", "-display", "none"])
            .args(["-serial", "none", "-monitor", "none"])
            .args(["-chardev", &server("debugger"), "-gdb", "chardev:debugger"])
            .args(["-chardev", &server("control"), "-mon", "chardev=control,mode=control"])
            .arg("-kernel")
            .arg(image)
            .stdin(Stdio::null())
            .spawn()
            .context("starting qemu-system-arm")?;
        let mut connect = |name: &str| -> Result<BufReader<UnixStream>> {
            let begun = Instant::now();
            loop {
                if let Ok(stream) = UnixStream::connect(port(name)) {
                    stream.set_read_timeout(Some(PATIENCE))?;
                    return Ok(BufReader::new(stream));
                }
                ensure!(process.try_wait()?.is_none(), "QEMU ended; its message is above");
                ensure!(begun.elapsed() < PATIENCE, "QEMU opens no port");
                sleep(Duration::from_millis(10));
            }
        };
        let (debugger, control) = (connect("debugger")?, connect("control")?);
        let mut qemu = Self { process, debugger, control, block: None };
        qemu.control.read_line(&mut String::new()).context("QEMU's greeting")?;
        qemu.execute("qmp_capabilities")?;
        Ok(qemu)
    }

    /// Lets the core run to the next breakpoint, and gives its address.
    fn arrive(&mut self) -> Result<u64> {
        self.block = None;
        self.ask("c")?;
        let registers = bytes(&self.ask("g")?);
        // Sixteen words, the last one the program counter.
        registers.and_then(|all| Some(value(all.get(60..64)?))).context("QEMU gives no registers")
    }

    /// Instructions since reset.
    fn instructions(&mut self) -> Result<u64> {
        let answer = self.execute("query-replay")?;
        answer["icount"].as_u64().context("QEMU does not count instructions")
    }

    fn execute(&mut self, command: &str) -> Result<serde_json::Value> {
        writeln!(self.control.get_mut(), "{{\"execute\": \"{command}\"}}")?;
        loop {
            let mut line = String::new();
            ensure!(self.control.read_line(&mut line)? > 0, "QEMU has gone");
            let mut answer: serde_json::Value = serde_json::from_str(&line)?;
            // Events come between.
            if let Some(answer) = answer.get_mut("return") {
                return Ok(answer.take());
            }
            ensure!(answer.get("error").is_none(), "{command}: {line}");
        }
    }

    /// What GDB's remote protocol answers: `$answer#checksum`.
    fn ask(&mut self, packet: &str) -> Result<String> {
        let sum = packet.bytes().fold(0u8, u8::wrapping_add);
        // In one piece, with the acknowledgement of the answer before: each piece wakes QEMU.
        self.debugger.get_mut().write_all(format!("+${packet}#{sum:02x}").as_bytes())?;
        let (mut answer, mut checksum) = (Vec::new(), [0; 2]);
        self.debugger.skip_until(b'$')?;
        self.debugger.read_until(b'#', &mut answer)?;
        self.debugger.read_exact(&mut checksum)?;
        answer.pop();
        Ok(String::from_utf8(answer)?)
    }

    fn order(&mut self, packet: &str) -> Result<()> {
        match &*self.ask(packet)? {
            "OK" => Ok(()),
            other => bail!("QEMU answers {other:?} to {packet}"),
        }
    }
}

/// Bytes of memory that are read at once: a packet has room for them.
const BLOCK: u64 = 1 << 10;

/// What hexadecimal digits say.
fn bytes(digits: &str) -> Option<Vec<u8>> {
    let byte = |n: usize| u8::from_str_radix(digits.get(n..n + 2)?, 16).ok();
    (0..digits.len()).step_by(2).map(byte).collect()
}

/// Of bytes, the least significant first.
fn value(bytes: &[u8]) -> u64 {
    bytes.iter().rev().fold(0, |value, &byte| value << 8 | u64::from(byte))
}

impl Memory for Qemu {
    fn read(&mut self, address: u64, width: Width) -> Result<u64, Error> {
        let begin = address / BLOCK * BLOCK;
        if self.block.as_ref().is_none_or(|block| block.0 != begin) {
            let digits = self.ask(&format!("m{begin:x},{BLOCK:x}")).ok();
            let bytes = digits.and_then(|digits| bytes(&digits)).ok_or(Error::Memory { address, width })?;
            self.block = Some((begin, bytes));
        }
        let from = (address - begin) as usize;
        let bytes = self.block.as_ref().and_then(|block| block.1.get(from..from + width.bytes() as usize));
        bytes.map(value).ok_or(Error::Memory { address, width })
    }

    fn write(&mut self, address: u64, width: Width, value: u64) -> Result<(), Error> {
        self.block = None;
        let bytes = value.to_le_bytes();
        let digits: String =
            bytes.iter().take(width.bytes() as usize).map(|byte| format!("{byte:02x}")).collect();
        self.order(&format!("M{address:x},{:x}:{digits}", width.bytes()))
            .map_err(|_| Error::Memory { address, width })
    }
}

impl Drop for Qemu {
    fn drop(&mut self) {
        // Whoever is gone already is what is wanted.
        let _ = self.debugger.get_ref().shutdown(Shutdown::Both);
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
