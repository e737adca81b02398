//! The whole fingertip: a frame goes in, a motor drive comes out.

use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Down, Event, Refusal, Slow};

/// The fingertip's memory between ticks.
#[derive(Debug, Default)]
pub struct Fingertip {}

impl Fingertip {
    /// Takes one frame, decides, says how to drive the motor until the next.
    pub fn tick(&mut self, _frame: &Frame) -> MotorDrive {
        MotorDrive::Coast
    }

    /// Carries out a command, or says why not.
    pub fn command(&mut self, _command: &Down) -> Result<(), Refusal> {
        Ok(())
    }

    /// The slow frame that the last tick ended, if it ended one.
    pub fn take_slow(&mut self) -> Option<Slow> {
        None
    }

    /// The oldest thing that happened and has not been taken yet.
    pub fn next_event(&mut self) -> Option<Event> {
        None
    }
}
