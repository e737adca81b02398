//! Commands of a scene on the serial line.

use std::collections::VecDeque;

use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{DRIVE_HOLD_MAX_MS, Down, Setting};

use crate::file::sections::{Command, CommandKind};

const REPEAT_S: f64 = 0.1;
const PRESS_S: f64 = 0.3;
const HELLO_S: f64 = 0.05;

/// The commands of a scene, in the order in which they are sent.
#[derive(Clone, Debug)]
pub(crate) struct Script {
    sent: VecDeque<(f64, Down)>,
    pressed_at_s: Vec<f64>,
}

impl Script {
    /// `trusted`: the board needs no session. Otherwise the script begins with the question for one; whoever connects the
    /// board answers the number that it offers.
    pub(crate) fn new(commands: &[Command], trusted: bool) -> Self {
        let mut sent: Vec<(f64, Down)> = commands.iter().flat_map(expand).collect();
        if !trusted && !commands.is_empty() {
            sent.push((HELLO_S, Down::Hello));
        }
        sent.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let presses = commands.iter().filter(|command| *command.kind.get_ref() == CommandKind::Consent);
        Self { sent: sent.into(), pressed_at_s: presses.map(|press| press.at_s.get()).collect() }
    }

    pub(crate) fn button(&self, t_s: f64) -> bool {
        self.pressed_at_s.iter().any(|at_s| (*at_s..at_s + PRESS_S).contains(&t_s))
    }

    pub(crate) fn take(&mut self, t_s: f64) -> Vec<Down> {
        let due = self.sent.iter().take_while(|(at_s, _)| *at_s <= t_s).count();
        self.sent.drain(..due).map(|(_, down)| down).collect()
    }
}

fn expand(command: &Command) -> Vec<(f64, Down)> {
    let at_s = command.at_s.get();
    let kind = *command.kind.get_ref();
    let duty = Duty::per_mille(command.duty_permille.as_ref().map_or(0, |duty| *duty.get_ref()));
    let once = |down| vec![(at_s, down)];
    match kind {
        CommandKind::Begin(what) => {
            let degrees = command.value.as_ref().map_or(0, |value| *value.get_ref());
            once(Down::Begin(match what {
                Behaviour::Turn { .. } => Behaviour::Turn { by_ddeg: (10 * degrees) as i16 },
                what => what,
            }))
        }
        CommandKind::End => once(Down::End),
        CommandKind::Zero => once(Down::Zero),
        CommandKind::Consent => Vec::new(),
        CommandKind::Close => held(at_s, command, MotorDrive::Close(duty)),
        CommandKind::Open => held(at_s, command, MotorDrive::Open(duty)),
        CommandKind::Set(id) => {
            // A file without it was refused.
            let value = command.value.as_ref().map_or(id.row().default, |value| *value.get_ref());
            once(Down::Set(Setting { id: id.number(), value }))
        }
    }
}

fn held(at_s: f64, command: &Command, drive: MotorDrive) -> Vec<(f64, Down)> {
    let for_s = command.for_s.map_or(0.0, |duration| duration.get());
    let repeats = (for_s / REPEAT_S).ceil() as u32;
    let one = |n| {
        let since_s = f64::from(n) * REPEAT_S;
        let left_ms = ((for_s - since_s) * 1e3).round() as u16;
        (at_s + since_s, Down::Drive { drive, hold_ms: left_ms.min(DRIVE_HOLD_MAX_MS) })
    };
    (0..repeats).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::plain;
    use tenax_logic::setting::SettingId;

    #[test]
    fn a_held_key_is_repeated_and_let_go_in_time() {
        let scene = plain(
            "",
            "[[command]]\nat_s = 1\nkind = 'close'\nduty_permille = 300\nfor_s = 0.32\n\
             [[command]]\nat_s = 0.5\nkind = 'set-s2-permille'\nvalue = 400\n",
        );
        assert!(scene.trusts_line(), "a script is a laboratory's");
        let mut script = Script::new(&scene.command, true);
        assert_eq!(script.take(0.499), []);
        assert_eq!(script.take(0.5), [Down::Set(Setting { id: SettingId::S2.number(), value: 400 })]);
        let drive = MotorDrive::Close(Duty::per_mille(300));
        assert_eq!(script.take(1.0), [Down::Drive { drive, hold_ms: 250 }]);
        assert_eq!(script.take(1.25).len(), 2);
        assert_eq!(script.take(9.0), [Down::Drive { drive, hold_ms: 20 }]);
        assert!(!script.button(0.5));
    }

    #[test]
    fn a_board_that_trusts_nobody_is_asked_for_a_session_and_somebody_presses_its_button() {
        let commands = "[[command]]\nat_s = 1\nkind = 'consent'\n[[command]]\nat_s = 1.5\nkind = 'zero'\n";
        let scene = plain("line_trusted = false\n", commands);
        let mut script = Script::new(&scene.command, scene.trusts_line());
        assert_eq!(script.take(0.2), [Down::Hello]);
        assert_eq!(script.take(1.4), []);
        assert_eq!(script.take(1.5), [Down::Zero]);
        assert_eq!([0.9, 1.1, 1.4].map(|t_s| script.button(t_s)), [false, true, false]);
    }
}
