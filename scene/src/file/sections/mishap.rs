//! What goes wrong.

use serde::Deserialize;
use toml::Spanned;

use crate::file::channel::ChannelName;
use crate::file::quantity::{
    Drift, Duration, Hertz, Instant, Milliseconds, Millivolts, Newtons, Part, RingHertz,
};

/// Something hits the hand or the table: a short ring in every film.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Knock {
    pub at_s: Instant,
    pub peak_mv: Millivolts,
    pub ring_hz: RingHertz,
    pub decay_ms: Milliseconds,
    #[serde(default = "Knock::alike")]
    pub uneven: Part,
}

impl Knock {
    const fn alike() -> Part {
        Part::of(0.0)
    }
}

/// Mains near by, in every film from an instant on, beside `[pvdf]`'s own.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hum {
    pub at_s: Instant,
    pub for_s: Duration,
    pub peak_mv: Millivolts,
    pub hum_hz: Hertz,
}

/// The motor that tells the wearer by vibrating, and how much of it the films hear. There is none that they hear without this table.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vibrator {
    pub film_mv: Millivolts,
    pub full_hz: Hertz,
    pub spin_ms: Milliseconds,
}

/// An electrode lifts off the skin: it hears no muscle, and more mains.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ElectrodeLift {
    pub at_s: Instant,
    pub for_s: Duration,
    pub channel: Spanned<ChannelName>,
    pub pickup_mv: Millivolts,
}

/// Something between the gear's teeth: the motor is blocked, the fingers stand still.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Jam {
    pub at_s: Instant,
    pub for_s: Duration,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaultKind {
    /// 0 V: a lost supply.
    Dead,
    /// Cut wire. Before a switch (100 kohm, 1 uF) the voltage falls; a film's amplifier loses its bias.
    Cut,
    /// Cut wire without the resistor: the switch keeps the charge of the input shown before.
    Open,
    /// Short to the supply.
    Saturated,
    /// The voltage of that instant without noise: an input that latched up.
    Stuck,
    /// `press_n` on a quadrant of the force sensor: a bent finger cover.
    Pressed,
    /// A reading that runs away by `drift_per_s`: a cell that creeps or warms, an amplifier whose offset wanders.
    Drift,
    Swapped,
    Bridged,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorFault {
    /// 0 is before the hand is switched on.
    pub at_s: Instant,
    pub until_s: Option<Instant>,
    pub channel: Spanned<ChannelName>,
    pub kind: FaultKind,
    pub press_n: Option<Spanned<Newtons>>,
    /// N/s for a quadrant of the force sensor, mV/s at the pin for any other channel.
    pub drift_per_s: Option<Spanned<Drift>>,
    pub with: Option<Spanned<ChannelName>>,
    #[expect(dead_code, reason = "it explains the file to its reader")]
    pub reason: String,
}
