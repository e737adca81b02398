//! Who is told of a run while it goes.

use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::Slow;

use super::Run;

pub trait Recorder {
    fn scan(&mut self, _codes: &Scan, _drive: MotorDrive) {}

    fn slow(&mut self, _slow: &Slow) {}

    fn line(&mut self, _bytes: &[u8]) {}
}

impl Recorder for () {}

impl<A: Recorder + ?Sized, B: Recorder + ?Sized> Recorder for (&mut A, &mut B) {
    fn scan(&mut self, codes: &Scan, drive: MotorDrive) {
        self.0.scan(codes, drive);
        self.1.scan(codes, drive);
    }

    fn slow(&mut self, slow: &Slow) {
        self.0.slow(slow);
        self.1.slow(slow);
    }

    fn line(&mut self, bytes: &[u8]) {
        self.0.line(bytes);
        self.1.line(bytes);
    }
}

/// The line alone.
impl Recorder for Vec<u8> {
    fn line(&mut self, bytes: &[u8]) {
        self.extend_from_slice(bytes);
    }
}

impl Recorder for Run {
    fn scan(&mut self, codes: &Scan, drive: MotorDrive) {
        self.scans.push(*codes);
        self.drives.push(drive);
    }

    fn slow(&mut self, slow: &Slow) {
        self.slows.push(slow.clone());
    }

    fn line(&mut self, bytes: &[u8]) {
        self.line.extend_from_slice(bytes);
    }
}

#[cfg(feature = "host")]
impl Recorder for tenax_frames::serve::Server {
    fn line(&mut self, bytes: &[u8]) {
        Self::line(self, bytes);
    }
}
