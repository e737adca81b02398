//! The channel map as a page for people: `docs/wiring.md`. A test holds that file against this.

use std::fmt::Write;

use tenax_hal_shim::channel::{
    CHANNELS, Channel, FRAME_HZ, Input, RANK_SWITCH_A, RANK_SWITCH_B, SCAN, SCAN_HZ, SLOW_HZ,
};

const HEAD: &str = "\
# Wiring

Printed from `hal-shim/src/channel.rs` by `cargo tenax wiring`; do not edit.

Board: NUCLEO-F411RE. Two CD74HC4067 switches share the select lines S0 to S3 on PB12 to PB15. The motor's bridge is on
PA8 (TIM1 channel 1, close) and PA9 (TIM1 channel 2, open), 20 kHz. The serial line is USART2 on PA2 (to the PC) and PA3,
through the ST-LINK's USB port.

A voltage below `low` is a cut wire, above `high` a short or a sensor pressed out of range.
";

/// The whole page.
pub fn markdown() -> String {
    let mut page = String::from(HEAD);
    // Writing into a String cannot fail.
    let _ = writeln!(
        page,
        "Every pin is read {SCAN_HZ} times a second; direct pins give {FRAME_HZ} samples a second, switched signals \
         {SLOW_HZ}.\n"
    );
    page += "| channel | pin | ADC1 input | switch, select | samples/s | rest mV | low mV | high mV |\n";
    page += "|---|---|---|---|---|---|---|---|\n";
    for channel in &CHANNELS {
        let _ = writeln!(page, "{}", row(channel));
    }
    page
}

fn row(channel: &Channel) -> String {
    let (rank, switch) = match channel.input {
        Input::Direct { rank } => (usize::from(rank), String::from("-")),
        Input::SwitchA { select } => (RANK_SWITCH_A, format!("A, {select}")),
        Input::SwitchB { select } => (RANK_SWITCH_B, format!("B, {select}")),
    };
    format!(
        "| `{}` | {} | IN{} | {switch} | {} | {} | {} | {} |",
        channel.name,
        SCAN[rank].pin,
        SCAN[rank].adc,
        channel.rate_hz(),
        channel.rest_mv,
        channel.low_mv,
        channel.high_mv
    )
}
