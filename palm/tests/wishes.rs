//! Whom the palm wishes for what, by what its fingers say.

use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::wire::{Receiver, encode};
use tenax_palm::bus::{CYCLE_US, FRAME_MAX, Felt, Packet, State, Word, bytes_us};
use tenax_palm::line::{Down, FRAME_UP_MAX, Lines, Up};
use tenax_palm::palm::Palm;
use tenax_palm::places::{Place, Places};

/// A palm whose fingers answer what they are told to, at once.
struct Hand {
    palm: Palm,
    states: Vec<Option<State>>,
    now_us: u32,
}

impl Hand {
    /// Around an object at these angles, degrees; each with 2 N of shear where S2 is 0.4.
    fn at(angles: &[f64]) -> Self {
        let normal =
            |angle: f64| [angle.to_radians().cos(), angle.to_radians().sin()].map(|part| (part * 1e3) as i16);
        let places: Vec<Place> = angles
            .iter()
            .zip(0..)
            .map(|(&angle, n)| Place { chip: [n, 0, 0], normal: normal(angle), ceiling_mn: 40_000 })
            .collect();
        let mut hand =
            Self { palm: Palm::new(&places, 0), states: vec![Some(felt(6_000)); angles.len()], now_us: 0 };
        for n in 0..places.len() {
            hand.hear(Packet { address: 0, word: Word::Here { chip: [n as u32, 0, 0], nonce: 1 } });
        }
        hand
    }

    fn hear(&mut self, packet: Packet) {
        let mut buffer = [0; FRAME_MAX];
        let frame = encode(1, &packet, &mut buffer).unwrap();
        frame.iter().for_each(|&byte| _ = self.palm.hear(byte, self.now_us));
    }

    /// So many cycles; what each finger is wished then, N.
    fn wishes(&mut self, cycles: u32) -> Vec<Option<f64>> {
        let from_us = self.now_us;
        while self.now_us - from_us < cycles * CYCLE_US {
            let mut out = [0; FRAME_MAX];
            let length = self.palm.step(self.now_us, &mut out);
            self.now_us += bytes_us(length as u32).max(10);
            let mut receiver = Receiver::new();
            let asked = out[..length].iter().find_map(|&byte| receiver.push::<Packet>(byte));
            if let Some(Ok(asked)) = asked
                && let Word::Poll(_) = asked.message.word
                && let Some(state) = self.states[usize::from(asked.message.address) - 1].clone()
            {
                self.hear(Packet { address: asked.message.address, word: Word::State(state) });
            }
        }
        (0..self.states.len()).map(|n| self.palm.want_mn(n).map(|mn| f64::from(mn) / 1e3)).collect()
    }
}

fn felt(load_mn: u16) -> State {
    State { felt: Some(Felt { load_mn, ft_mn: 2_000, friction_permille: 400 }), ..State::default() }
}

#[test]
fn who_lacks_margin_is_wished_the_least_force_and_nobody_else_anything() {
    let mut pair = Hand::at(&[0.0, 180.0]);
    assert_eq!(pair.wishes(20), [None, None]);
    pair.states[1] = Some(felt(4_500));
    pair.states[0] = Some(felt(4_500));
    assert_eq!(pair.wishes(20), [Some(5.0), Some(5.0)], "2 N over 0.4");
    // While one slips, all keep 5 % more; and a while longer.
    pair.states[0].as_mut().unwrap().slip = DetectorSet::only(DetectorId::S1);
    assert_eq!(pair.wishes(2), [Some(5.25), Some(5.25)]);
    pair.states[0] = Some(felt(4_500));
    assert_eq!(pair.wishes(45), [Some(5.25), Some(5.25)]);
    assert_eq!(pair.wishes(20), [Some(5.0), Some(5.0)]);
}

#[test]
fn who_holds_something_keeps_its_fingers() {
    let mut pair = Hand::at(&[0.0, 180.0]);
    let (mut lines, keep) = (Lines::default(), Down::Keep(Places::new()));
    let mut tell = |palm: &mut Palm, down: &Down| {
        let mut buffer = [0; 256];
        let frame = encode(1, down, &mut buffer).unwrap();
        let wished = frame.iter().find_map(|&byte| lines.hear(byte, palm));
        let mut out = [0; FRAME_UP_MAX];
        let length = lines.next(palm, &mut out);
        let mut receiver = Receiver::new();
        (
            wished,
            out[..length].iter().find_map(|&byte| receiver.push::<Up>(byte)).map(|up| up.unwrap().message),
        )
    };
    pair.wishes(5);
    while pair.palm.next_report().is_some() {}
    assert_eq!(tell(&mut pair.palm, &keep), (None, Some(Up::Refused)));
    assert_eq!(tell(&mut pair.palm, &Down::Ask), (None, Some(Up::Hand(pair.palm.places()))));
    pair.states = vec![Some(State::default()); 2];
    pair.wishes(5);
    assert_eq!(tell(&mut pair.palm, &keep), (Some(Places::new()), None));
}

#[test]
fn a_thumb_that_bears_enough_is_wished_nothing() {
    let mut hand = Hand::at(&[0.0, 180.0, 180.0, 180.0, 180.0]);
    hand.states = [12_000, 6_000, 3_000, 1_500, 1_500].map(|mn| Some(felt(mn))).into();
    assert_eq!(hand.wishes(20), [None, None, Some(5.0), Some(5.0), Some(5.0)]);
}

#[test]
fn an_active_muscle_at_any_finger_silences_the_palm() {
    let mut pair = Hand::at(&[0.0, 180.0]);
    pair.states = vec![Some(felt(4_000)); 2];
    assert_eq!(pair.wishes(20), [Some(5.0), Some(5.0)]);
    pair.states[1].as_mut().unwrap().wearer = true;
    assert_eq!(pair.wishes(1), [None, None], "at once");
    assert_eq!(pair.wishes(20), [None, None]);
    pair.states[1].as_mut().unwrap().wearer = false;
    assert_eq!(pair.wishes(20), [Some(5.0), Some(5.0)]);
}

#[test]
fn where_a_ceiling_is_in_the_way_or_only_one_is_felt_every_finger_is_on_its_own() {
    let mut pair = Hand::at(&[0.0, 180.0]);
    let icy = Felt { load_mn: 10_000, ft_mn: 5_000, friction_permille: 100 };
    pair.states = vec![Some(State { felt: Some(icy), ..State::default() }), Some(felt(4_000))];
    assert_eq!((pair.wishes(20), pair.palm.is_lacking()), (vec![None, None], true));
    pair.states[0] = Some(State::default());
    assert_eq!((pair.wishes(20), pair.palm.is_lacking()), (vec![None, None], false));
}

#[test]
fn a_lost_finger_holds_as_a_wall_until_the_others_let_go() {
    // Three around a ball, of which one is lost: its gear holds, and the others press against it.
    let mut ball = Hand::at(&[90.0, 210.0, 330.0]);
    ball.states = [4_500, 4_500, 4_500].map(|mn| Some(felt(mn))).into();
    assert_eq!(ball.wishes(20), [Some(5.0), Some(5.0), Some(5.0)]);
    ball.states[0] = None;
    let wishes = ball.wishes(20);
    assert_eq!((wishes[0], ball.palm.state(0)), (None, None));
    // It presses as they press against it.
    assert_eq!((&wishes[1..], ball.palm.is_lacking()), (&[Some(5.0), Some(5.0)][..], false));
    // They let go: what it holds now nobody knows.
    ball.states[1..].fill(Some(State::default()));
    ball.wishes(20);
    ball.states[1..].fill(Some(felt(4_500)));
    assert_eq!((ball.wishes(20), ball.palm.is_lacking()), (vec![None; 3], true));
}
