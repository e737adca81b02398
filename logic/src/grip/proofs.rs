//! What binds the reflex, shown over every state of small domains: the ceiling by enumeration, the budget by a search that ends.

use std::collections::BTreeSet;
use std::vec::Vec;

use super::*;
use crate::config::Config;
use crate::mode::{closes, next};
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::words::Cause;

/// The ends of the range of ceilings, a trusted line's and a person's, and some between.
const CEILINGS_MN: [i32; 5] = [3_000, 3_001, 20_000, 40_000, 60_000];

// Shows R2.
#[test]
fn at_the_ceiling_nothing_closes_whatever_state_the_reflex_is_in() {
    let defaults = Config::default().grip;
    let budget = defaults.blind_frames;
    for ceiling_mn in CEILINGS_MN {
        let config = GripConfig { ceiling_mn, ..defaults };
        for (blind, bound) in
            [0, budget - 1, budget, u32::MAX].map(|blind| [(blind, false), (blind, true)]).concat()
        {
            let reflex =
                Reflex { account: Account { blind, ..Account::default() }, bound, ..Reflex::default() };
            for mn in 0..=61_000 {
                let (grip, below) = (Grip::Holds(mn), mn < ceiling_mn);
                assert_eq!(reflex.link_may_close(&config, grip), below);
                assert_eq!(reflex.may_close(&config, grip), below && (!bound || blind < budget));
            }
            for (elapsed, left) in [0, 1, 5, 6, 1_000]
                .map(|elapsed| [None, Some(0), Some(1)].map(|left| (elapsed, left)))
                .concat()
            {
                for (mode, slips) in
                    [GripMode::Slip, GripMode::Incipient].map(|mode| [(mode, false), (mode, true)]).concat()
                {
                    let reflex = Reflex { elapsed, left, ..reflex };
                    for mn in [ceiling_mn, ceiling_mn + 1, i32::MAX] {
                        assert!(reflex.pulse_over(&config, mode, slips, Grip::Holds(mn)), "{reflex:?}");
                    }
                    assert!(reflex.pulse_over(&config, mode, slips, Grip::Unloaded), "{reflex:?}");
                }
            }
        }
    }
}

type State = (usize, u32, u32, u32);
/// The modes by their numbers.
const MODES: [GripMode; 6] = [
    GripMode::Standby,
    GripMode::Wearer,
    GripMode::Watch,
    GripMode::Slip,
    GripMode::Incipient,
    GripMode::Settle,
];

fn reachable(config: &GripConfig, grips: &[Grip], bound: bool) -> BTreeSet<State> {
    const ID: DetectorId = DetectorId::S1;
    let causes = [
        None,
        Some(Cause::SensorsReady),
        Some(Cause::SensorsLost),
        Some(Cause::TakenOver),
        Some(Cause::Released),
        Some(Cause::Settled),
        Some(Cause::Slip(ID)),
        Some(Cause::Incipient(ID)),
    ];
    let begins = (GripMode::Standby as usize, 0, 0, 0);
    let (mut known, mut open) = (BTreeSet::from([begins]), Vec::from([begins]));
    while let Some((mode, blind, elapsed, closed)) = open.pop() {
        let mut reached = Vec::new();
        for (&grip, first) in grips.iter().flat_map(|grip| causes.map(|cause| (grip, cause))) {
            for (second, slips) in causes.map(|cause| [(cause, false), (cause, true)]).concat() {
                let mut reflex = Reflex {
                    account: Account { blind, ..Account::default() },
                    elapsed,
                    bound,
                    ..Reflex::default()
                };
                let (mut mode, mut closed) = (MODES[mode], closed);
                for cause in [first, second].into_iter().flatten() {
                    let asked = !matches!(cause, Cause::Slip(_) | Cause::Incipient(_))
                        || reflex.may_close(config, grip);
                    if let Some(to) = next(mode, cause).filter(|_| asked) {
                        mode = to;
                        reflex.enter(mode, grip, None);
                    }
                }
                if closes(mode) && reflex.pulse_over(config, mode, slips, grip) {
                    mode = next(mode, Cause::PulseOver).expect("a pulse ends");
                    reflex.enter(mode, grip, None);
                }
                closed += u32::from(closes(mode));
                reflex.tick(mode, grip, false);
                let longest = config.slip_frames_max + config.settle_frames;
                let Reflex { account: Account { blind, .. }, elapsed, .. } = reflex;
                reached.push((mode as usize, blind, elapsed.min(longest), closed));
            }
        }
        reached.push((GripMode::Wearer as usize, 0, 0, 0));
        open.extend(
            reached.into_iter().filter(|state| state.3 <= config.blind_frames + 1 && known.insert(*state)),
        );
    }
    known
}

// Shows R3.
#[test]
fn no_history_closes_for_longer_than_the_budget() {
    let config = GripConfig {
        blind_frames: 5,
        slip_frames: 2,
        slip_frames_max: 3,
        incipient_frames: 1,
        settle_frames: 2,
        ..Config::default().grip
    };
    let felt = [Grip::Unknown, Grip::Unloaded, Grip::Holds(5_000), Grip::Holds(config.ceiling_mn)];
    for (grips, bound) in [(&felt[..1], false), (&felt[..2], false), (&felt[..], true)] {
        let states = reachable(&config, grips, bound);
        let most = states.iter().map(|state| state.3).max();
        assert_eq!(
            most,
            Some(config.blind_frames),
            "the budget is spent and no frame more, {} states",
            states.len()
        );
    }
    // The control: a force that is felt spends nothing.
    let states = reachable(&config, &felt[2..3], false);
    assert!(states.iter().any(|state| state.3 > config.blind_frames));
}
