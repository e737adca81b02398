//! Channels and settings as Markdown tables: `tenax tables`.

use tenax_hal_shim::channel::{
    CHANNELS, Channel, FRAME_HZ, Input, RANK_SWITCH_A, RANK_SWITCH_B, SCAN, SCAN_HZ, SLOW_HZ,
};
use tenax_logic::setting::SettingId;

const SIGNALS: &str = "\
# Wiring

| other signals of the NUCLEO-F411RE | pins |
|---|---|
| select lines S0 to S3, shared by both CD74HC4067 switches | PB12 to PB15 |
| motor bridge, 20 kHz: close, open | PA8 (TIM1 channel 1), PA11 (TIM1 channel 4) |
| vibration motor, 20 kHz | PB6 (TIM4 channel 1) |
| button to ground | PC13 |
| light: series resistor and LED to ground | PC6 |
| nFAULT of the motor bridge | PC8 |
| serial line USART2 through the ST-LINK: to the PC, from it | PA2, PA3 |
| known voltages, against broken select lines | switch B: 14 at 3.3 V, 15 at ground |

";

pub fn wiring() -> String {
    let mut page = format!(
        "{SIGNALS}Every pin is read {SCAN_HZ} times a second. Direct pins give {FRAME_HZ} samples a second, switched \
         signals {SLOW_HZ}, myosensors {}.\nA voltage below `low` is a cut wire, above `high` a short or a sensor out of \
         range. Cut wires of films and myosensors can\nstay within these limits.\n\n\
         | channel | input | pin | ADC1 input | rest mV | low mV | high mV |\n|---|---|---|---|---|---|---|\n",
        3 * SLOW_HZ
    );
    for (n, channel) in CHANNELS.iter().enumerate() {
        let Channel { name, rest_mv, low_mv, high_mv, .. } = channel;
        let pin = &SCAN[match channel.input {
            Input::Direct { rank } => rank.into(),
            Input::SwitchA { .. } => RANK_SWITCH_A,
            Input::SwitchB { .. } => RANK_SWITCH_B,
        }];
        page += &format!(
            "| `{name}` | {} | {} | IN{} | {rest_mv} | {low_mv} | {high_mv} |\n",
            input(n),
            pin.pin,
            pin.adc
        );
    }
    page
}

/// The input of a channel: `PA0`, or `switch A, 3`.
pub fn input(channel: usize) -> String {
    match CHANNELS[channel].input {
        Input::Direct { rank } => SCAN[usize::from(rank)].pin.to_owned(),
        Input::SwitchA { select } => format!("switch A, {select}"),
        Input::SwitchB { select } => format!("switch B, {select}"),
    }
}

pub fn settings() -> String {
    let mut page = String::from(
        "# Settings\n\nThe number names the setting on the wire and in flash.\n\n\
         | number | name with unit | range | default | meaning |\n|---|---|---|---|---|\n",
    );
    for id in SettingId::ALL {
        let (row, number, range) = (id.row(), id.number(), id.row().range());
        let (start, end) = range.into_inner();
        page += &format!(
            "| {number} | `{}` | {start} to {end} | {} | {} |\n",
            row.name, row.default, row.meaning
        );
    }
    page
}
