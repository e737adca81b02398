//! Numbers of a scene file: each kind knows what it may be, so that a wrong one is refused where it stands.

use serde::Deserialize;

/// A number outside what its kind allows.
#[derive(Debug, thiserror::Error)]
#[error("{value} is outside {low}..={high}")]
pub struct OutOfRange {
    value: f64,
    low: f64,
    high: f64,
}

macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident: $low:literal to $high:literal;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
        #[serde(try_from = "f64")]
        pub struct $name(f64);

        impl $name {
            /// A value known when compiling. Outside the range it does not compile in a constant.
            pub const fn of(value: f64) -> Self {
                assert!(value >= $low && value <= $high, "outside its range");
                Self(value)
            }

            pub const fn get(self) -> f64 {
                self.0
            }
        }

        impl TryFrom<f64> for $name {
            type Error = OutOfRange;

            // NaN is in no range.
            fn try_from(value: f64) -> Result<Self, OutOfRange> {
                let allowed = $low..=$high;
                allowed.contains(&value).then_some(Self(value)).ok_or(OutOfRange { value, low: $low, high: $high })
            }
        }
    )*};
}

quantities! {
    /// An instant, s.
    Instant: 0.0 to 3600.0;
    /// How long something lasts, s: at least one scan.
    Duration: 0.000125 to 3600.0;
    /// How fast a reading runs away, N/s or mV/s.
    Drift: -1000.0 to 1000.0;
    /// How long something short lasts, ms.
    Milliseconds: 0.125 to 1000.0;
    /// The motor's dead time, ms.
    DeadTime: 0.0 to 200.0;
    /// A friction coefficient.
    Mu: 0.05 to 3.0;
    /// A mass, kg.
    Kilograms: 0.0005 to 20.0;
    /// A mass that comes or goes, kg.
    KilogramsAdded: -20.0 to 20.0;
    /// A force, N.
    Newtons: 0.0 to 200.0;
    /// The greatest force of something, N.
    NewtonsMax: 1.0 to 200.0;
    /// The force of another hand at the object, N, either way.
    Pulling: -200.0 to 200.0;
    /// A small force, mN.
    Millinewtons: 0.0 to 1000.0;
    /// A direction, degrees.
    Direction: -360.0 to 360.0;
    /// An angle, degrees.
    Degrees: 0.0 to 90.0;
    /// A length, mm.
    Millimetres: 0.01 to 300.0;
    /// A very short way, um.
    Micrometres: 1.0 to 1000.0;
    /// A short way, mm: 0 is none.
    Play: 0.0 to 20.0;
    /// Where a load hangs beside or under the pads, mm, either way.
    Lever: -100.0 to 100.0;
    /// A height, mm: below 0 the hand would push through the table.
    Height: 0.0 to 2000.0;
    /// A stiffness, N/mm.
    Stiffness: 0.01 to 1000.0;
    /// Damping as a part of critical damping.
    Damping: 0.0 to 2.0;
    /// A speed, mm/s.
    Speed: 0.01 to 500.0;
    /// The speed of a carriage, mm/s, either way.
    Velocity: -500.0 to 500.0;
    /// An acceleration, m/s^2.
    Acceleration: 0.0 to 30.0;
    /// A frequency below half the frame rate, Hz.
    Hertz: 0.01 to 1000.0;
    /// What a knock rings at, Hz: the films are scanned four times a frame, so more than half the frame rate folds down.
    RingHertz: 0.01 to 2000.0;
    /// A voltage, mV.
    Millivolts: 0.0 to 3300.0;
    /// A factor without unit.
    Gain: 0.0 to 1000.0;
    /// A part of a whole.
    Part: 0.0 to 1.0;
}
