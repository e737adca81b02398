//! Bring-up of a real board in ten steps: what a person does at each, and what the line says of it meanwhile.
//!
//! A step is a row of [`STEPS`] and one function that hears the line and gives figures. A figure with limits passes or fails.

mod cuts;
mod harness;
mod noise;
mod outputs;
mod starts;
mod time;
mod wire;
mod wires;

use std::fmt;
use std::time::Duration;

use serde::Serialize;

pub use self::harness::{HARNESS, harness};
pub use self::noise::readings;
pub use self::wire::{Stream, Wire};
use super::Say;

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    pub name: String,
    pub value: f64,
    pub unit: &'static str,
    /// Between which it passes. None: informational.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limits: Option<[f64; 2]>,
}

impl Figure {
    /// One that neither passes nor fails.
    pub fn told(name: impl Into<String>, value: impl Into<f64>, unit: &'static str) -> Self {
        Self { name: name.into(), value: value.into(), unit, limits: None }
    }

    /// The same, and it passes between these.
    #[must_use]
    pub fn within(self, least: f64, most: f64) -> Self {
        Self { limits: Some([least, most]), ..self }
    }

    /// A count that has to be 0.
    pub fn none(name: impl Into<String>, count: impl Into<f64>) -> Self {
        Self::told(name, count, "").within(0.0, 0.0)
    }

    pub fn passes(&self) -> bool {
        self.limits.is_none_or(|[least, most]| (least..=most).contains(&self.value))
    }
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, value, unit, limits } = self;
        let digits = if value.fract() == 0.0 { 0 } else { 2 };
        write!(f, "   {name:<44}{value:>10.digits$} {unit:<4}")?;
        let Some([least, most]) = limits else { return Ok(()) };
        f.write_str(if self.passes() { " pass" } else { " FAIL" })?;
        match (*least, *most) {
            (least, most) if least == most => write!(f, ", has to be {most}"),
            (least, f64::INFINITY) => write!(f, ", at least {least}"),
            (f64::NEG_INFINITY | 0.0, most) => write!(f, ", at most {most}"),
            (least, most) => write!(f, ", {least} to {most}"),
        }
    }
}

/// What is asked for beside the step.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// How long it lasts. None: as long as it should.
    pub lasts: Option<Duration>,
    /// How often something is to be done. None: as often as it should.
    pub times: Option<u32>,
    /// The channels that are looked at, indices.
    pub channels: Vec<usize>,
    /// A shell's command that cuts the power and restores it. None: a person does.
    pub cut_power: Option<String>,
}

type Run = fn(&mut Wire<'_>, &Asked, Say<'_>) -> anyhow::Result<Vec<Figure>>;

pub struct Step {
    pub name: &'static str,
    /// What a person does.
    pub todo: &'static str,
    pub run: Run,
}

pub const STEPS: [Step; 10] = [
    Step {
        name: "power",
        todo: "Measure 3.3 V, and more than 1 kohm from it to ground. Then switch the board on, or press its black button.",
        run: starts::power,
    },
    Step {
        name: "sweep",
        todo: "Lower the 3.3 V slowly to 2.8 V and raise them again: the board has to stop at 2.93 V and to come back at 3.03 V.",
        run: starts::sweep,
    },
    Step {
        name: "clock",
        todo: "Repeat this with the board on USB, on a charger and on the battery.",
        run: time::clock,
    },
    Step {
        name: "timing",
        todo: "A logic analyser on PB12 sees a step every 0.5 ms, within 5 us.",
        run: time::timing,
    },
    Step {
        name: "line",
        todo: "Everything is streamed, and a command is sent each second. Touch nothing.",
        run: time::line,
    },
    Step {
        name: "noise",
        todo: "Connect every input that is looked at to 1.65 V instead of its sensor.",
        run: noise::noise,
    },
    Step {
        name: "wires",
        todo: "Take off each wire of the switches in any order, for a second, and put it back.",
        run: wires::wires,
    },
    Step {
        name: "outputs",
        todo: "Connect a resistor instead of the motor, which draws 50 to 120 mA, less than a stall. An oscilloscope on PA8 and PA9 sees both low when \
               the board is off.",
        run: outputs::outputs,
    },
    Step {
        name: "interference",
        todo: "Connect the motor; nothing touches the finger.",
        run: noise::interference,
    },
    Step {
        name: "cuts",
        todo: "The power is cut while a setting is saved, again and again. With --cut-power a command does it.",
        run: cuts::cuts,
    },
];

impl Step {
    /// Says what to do, measures, and says the figures.
    pub fn measure(&self, wire: &mut Wire<'_>, asked: &Asked, say: Say<'_>) -> anyhow::Result<Vec<Figure>> {
        say(self.todo)?;
        let figures = (self.run)(wire, asked, say)?;
        figures.iter().try_for_each(|figure| say(&figure.to_string()))?;
        let failed = figures.iter().filter(|figure| !figure.passes()).count();
        say(&match failed {
            0 => format!("{}: pass", self.name),
            _ => format!("{}: FAIL, {failed} of {} figures", self.name, figures.len()),
        })?;
        Ok(figures)
    }
}
