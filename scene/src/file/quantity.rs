//! Numbers of a scene file: each kind knows what it may be, so that a wrong one is refused where it stands.

use serde::Deserialize;
use tenax_hal_shim::channel::{CHANNELS, by_name};

use super::near;

macro_rules! quantities {
    ($($name:ident: $low:literal to $high:literal;)*) => {$(
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
        #[serde(try_from = "f64")]
        pub struct $name(f64);

        impl $name {
            /// A value known when compiling. Outside the range it does not compile in a constant.
            #[allow(dead_code, reason = "only kinds of which a section has a default are made so")]
            pub const fn of(value: f64) -> Self {
                assert!(value >= $low && value <= $high, "outside its range");
                Self(value)
            }

            pub const fn get(self) -> f64 {
                self.0
            }
        }

        impl TryFrom<f64> for $name {
            type Error = String;

            // NaN is in no range.
            fn try_from(value: f64) -> Result<Self, String> {
                let allowed = $low..=$high;
                let wrong = || format!("{value} is outside {}..={}", allowed.start(), allowed.end());
                allowed.contains(&value).then_some(Self(value)).ok_or_else(wrong)
            }
        }
    )*};
}

quantities! {
    Instant: 0.0 to 3600.0; // s
    Duration: 0.000125 to 3600.0; // s, at least one scan
    Drift: -1000.0 to 1000.0; // N/s or mV/s
    Milliseconds: 0.125 to 1000.0;
    DeadTime: 0.0 to 200.0; // ms
    Mu: 0.05 to 3.0;
    Kilograms: 0.0005 to 20.0;
    KilogramsAdded: -20.0 to 20.0;
    Newtons: 0.0 to 200.0;
    NewtonsMax: 1.0 to 200.0;
    Pulling: -200.0 to 200.0; // N
    Millinewtons: 0.0 to 1000.0;
    Degrees: 0.0 to 90.0;
    Millimetres: 0.01 to 300.0;
    Micrometres: 1.0 to 1000.0;
    Play: 0.0 to 20.0; // mm, 0 is none
    Lever: -100.0 to 100.0; // mm
    Height: 0.0 to 2000.0; // mm, below 0 the hand would push through the table
    Stiffness: 0.01 to 1000.0; // N/mm
    Damping: 0.0 to 2.0; // part of critical damping
    Speed: 0.01 to 500.0; // mm/s
    Velocity: -500.0 to 500.0; // mm/s
    Acceleration: 0.0 to 30.0; // m/s^2
    Hertz: 0.01 to 1000.0; // below half the frame rate
    RingHertz: 0.01 to 2000.0; // films are scanned four times a frame, so more than half the frame rate folds down
    Millivolts: 0.0 to 3300.0;
    Gain: 0.0 to 1000.0;
    Part: 0.0 to 1.0;
}

/// Index of a channel in [`CHANNELS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct ChannelName(usize);

impl ChannelName {
    pub const fn index(self) -> usize {
        self.0
    }

    pub const fn name(self) -> &'static str {
        CHANNELS[self.0].name
    }
}

impl TryFrom<String> for ChannelName {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        by_name(&name).map(Self).ok_or_else(|| {
            let near = near(&name, CHANNELS.iter().map(|channel| channel.name));
            format!("no channel is called `{name}`; near it: {near}")
        })
    }
}
