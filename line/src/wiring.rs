//! The channel map as a page for people: `docs/wiring.md`. A test holds that file against this.

use std::fmt::Write;

use tenax_hal_shim::channel::{
    CHANNELS, Channel, FRAME_HZ, Input, RANK_SWITCH_A, RANK_SWITCH_B, SCAN, SCAN_HZ, SLOW_HZ,
};

const HEAD: &str = "\
# Wiring

This page lists the pin of each channel and its valid voltages, for builders who connect sensors. [Hardware](hardware.md) has the circuits.

![sensors, switches, board and outputs](figures/wiring.svg)

<!-- Printed from hal-shim/src/channel.rs by cargo tenax wiring; do not edit. -->

| other signals of the NUCLEO-F411RE | pins |
|---|---|
| select lines S0 to S3, shared by both CD74HC4067 switches | PB12 to PB15 |
| motor bridge, 20 kHz: close, open | PA8 (TIM1 channel 1), PA9 (TIM1 channel 2) |
| [vibration motor](hardware.md#vibration-motor), 20 kHz | PB6 (TIM4 channel 1) |
| button to ground | PC13 |
| light: series resistor and LED to ground | PC6 |
| nFAULT of the motor bridge | PC8 |
| serial line USART2 through the ST-LINK: to the PC, from it | PA2, PA3 |
| known voltages, against broken select lines | switch B: 14 at 3.3 V, 15 at ground |

";

pub fn markdown() -> String {
    let mut page = String::from(HEAD);
    // Writing into a String cannot fail.
    let _ = writeln!(
        page,
        "Every pin is read {SCAN_HZ} times a second. Direct pins give {FRAME_HZ} samples a second, switched signals {SLOW_HZ}, myosensors {}. \
         A\nvoltage below `low` is a cut wire, above `high` a short or a sensor out of range. Cut wires of [films](hardware.md#pvdf-films) and \
         myosensors can\nstay within these limits.\n",
        3 * SLOW_HZ
    );
    page += "| channel | pin | ADC1 input | switch, select | rest mV | low mV | high mV |\n";
    page += "|---|---|---|---|---|---|---|\n";
    for channels in CHANNELS.chunk_by(are_alike) {
        let _ = writeln!(page, "{}", row(channels));
    }
    page
}

/// Neighbours on the same switch, of one kind of sensor, with the same voltages.
fn are_alike(a: &Channel, b: &Channel) -> bool {
    let kind = |channel: &Channel| channel.name.split('_').next().map(str::to_owned);
    let voltages = |channel: &Channel| (channel.rest_mv, channel.low_mv, channel.high_mv);
    let (a_rank, b_rank) = (place(a).0, place(b).0);
    a_rank == b_rank && kind(a) == kind(b) && voltages(a) == voltages(b)
}

/// The rank in the scan, and the switch with its select.
fn place(channel: &Channel) -> (usize, Option<(char, u8)>) {
    match channel.input {
        Input::Direct { rank } => (usize::from(rank), None),
        Input::SwitchA { select } => (RANK_SWITCH_A, Some(('A', select))),
        Input::SwitchB { select } => (RANK_SWITCH_B, Some(('B', select))),
    }
}

/// Where a channel's wire ends: `PA0`, or `switch A, 3`.
pub fn input(channel: usize) -> String {
    match place(&CHANNELS[channel]) {
        (rank, None) => SCAN[rank].pin.to_owned(),
        (_, Some((switch, select))) => format!("switch {switch}, {select}"),
    }
}

/// The row of channels that are alike.
fn row(channels: &[Channel]) -> String {
    let (Some(first), Some(last)) = (channels.first(), channels.last()) else { return String::new() };
    let (rank, from) = place(first);
    let (names, selects) = match (from, place(last).1) {
        (Some((switch, from)), Some((_, to))) if from != to => {
            (format!("`{}` to `{}`", first.name, last.name), format!("{switch}, {from} to {to}"))
        }
        (Some((switch, from)), _) => (format!("`{}`", first.name), format!("{switch}, {from}")),
        (None, _) => (format!("`{}`", first.name), String::from("-")),
    };
    format!(
        "| {names} | {} | IN{} | {selects} | {} | {} | {} |",
        SCAN[rank].pin, SCAN[rank].adc, first.rest_mv, first.low_mv, first.high_mv
    )
}
