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
    pub at_s: Spanned<Instant>,
    /// First peak, at the film.
    pub peak_mv: Millivolts,
    pub ring_hz: RingHertz,
    /// Until it has fallen to 1/e.
    pub decay_ms: Milliseconds,
    /// How unlike the films hear it: 0 is all alike, 1 is from nothing to twice the peak, by where the film lies.
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
    pub at_s: Spanned<Instant>,
    pub for_s: Duration,
    /// Peak at the film.
    pub peak_mv: Millivolts,
    pub hum_hz: Hertz,
}

/// The motor that tells the wearer by vibrating, and how much of it the films hear. There is none that they hear without this table.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vibrator {
    /// Peak at a film of mean gain, at full speed.
    pub film_mv: Millivolts,
    /// Turns a second at full duty.
    pub full_hz: Hertz,
    /// Time constant with which it speeds up and runs down.
    pub spin_ms: Milliseconds,
}

/// An electrode lifts off the skin: it hears no muscle, and more mains.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ElectrodeLift {
    pub at_s: Spanned<Instant>,
    pub for_s: Duration,
    /// `myo_flexor` or `myo_extensor`.
    pub channel: Spanned<ChannelName>,
    /// What it picks up instead, above rest.
    pub pickup_mv: Millivolts,
}

/// Something between the gear's teeth: the motor is blocked, the fingers stand still.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Jam {
    pub at_s: Spanned<Instant>,
    pub for_s: Duration,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaultKind {
    /// 0 V: a cut wire, a lost supply.
    Dead,
    /// Its wire is cut. Before a switch's input that has 100 kohm to ground and 1 uF, as docs/hardware.md asks for: the voltage falls.
    /// Before a film's amplifier: it loses its bias.
    Cut,
    /// The same without the resistor: the switch's output keeps the charge of the input that was shown before.
    Open,
    /// The supply: a short.
    Saturated,
    /// The voltage of that instant, for ever, without noise: a converter input or a switch that latched up.
    Stuck,
    /// A quadrant of the force sensor with `press_n` on it that nobody put there: a bent finger cover.
    Pressed,
    /// A reading that runs away by `drift_per_s`: a cell that creeps or warms, an amplifier whose offset wanders.
    Drift,
    /// Its wire and that of `with` have changed places.
    Swapped,
    /// Its wire and that of `with` touch each other.
    Bridged,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorFault {
    /// When. 0 is before the hand is switched on.
    pub at_s: Spanned<Instant>,
    /// When it works again; never without it.
    pub until_s: Option<Spanned<Instant>>,
    pub channel: Spanned<ChannelName>,
    pub kind: FaultKind,
    pub press_n: Option<Spanned<Newtons>>,
    /// The rate of `drift`: of a quadrant of the force sensor N/s, of any other channel mV/s at the pin.
    pub drift_per_s: Option<Spanned<Drift>>,
    /// The other channel of `swapped` and `bridged`.
    pub with: Option<Spanned<ChannelName>>,
    /// The physical reason.
    pub reason: String,
}
