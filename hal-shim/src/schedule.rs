//! Schedule of the 25 slots of a slow frame: which inputs the switches show, which channels
//! are read from them, and which job of the logic runs.
//!
//! It is derived from the channel map. Sixteen slots show each input once. The nine slots left over read the myosensors
//! twice more, so that their readings are never more than 6.5 ms apart. In the other slots
//! the lines rest on input 0, which has long settled when its turn comes; those readings are not used.

use crate::channel::{
    ARRAY, ARRAY_COUNT, CHANNELS, FRAMES_PER_SLOW_FRAME, FSR, FSR_COUNT, Input, MYO_EXTENSOR, MYO_FLEXOR,
    SWITCH_INPUTS,
};

pub const SLOTS: usize = FRAMES_PER_SLOW_FRAME as usize;

/// Slots that share the array's work, one after the other: in fewer, a tick would last into the next frame.
pub const ARRAY_SHARES: u8 = 5;

/// A job that runs once a slow frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Job {
    /// All quadrants of the force sensor have been read: computes forces, Ft/Fn and S2, or a photoelastic head's force if the
    /// quadrants give none.
    Forces,
    /// All elements of the array have been read: computes the first of [`ARRAY_SHARES`] shares of the features and the network.
    ArrayBegins,
    /// Computes the last share: the MLP's verdict.
    MlpDecides,
    /// Slow work on muscles and films, far from the last slot, which has the most to do.
    Think,
    /// The board asks the fingertip for a record to save.
    Save,
    /// The slow frame's message is completed.
    EndOfCycle,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// State of the select lines, 0 to 15.
    pub select: u8,
    /// The channel that is read from switch A, an index in [`CHANNELS`].
    pub switch_a: Option<u8>,
    pub switch_b: Option<u8>,
}

/// The slots that are left when each input has been shown once, and the channel that each reads. None: the lines rest.
const AGAIN: [Option<usize>; SLOTS - SWITCH_INPUTS as usize] = [
    Some(MYO_FLEXOR),
    Some(MYO_EXTENSOR),
    None,
    None,
    None,
    None,
    Some(MYO_FLEXOR),
    Some(MYO_EXTENSOR),
    None,
];

pub static SCHEDULE: [Slot; SLOTS] = {
    let mut slots = [Slot { select: 0, switch_a: None, switch_b: None }; SLOTS];
    let mut select = 0;
    while select < SWITCH_INPUTS {
        slots[select as usize].select = select;
        select += 1;
    }
    let mut channel = 0;
    while channel < CHANNELS.len() {
        match CHANNELS[channel].input {
            Input::Direct { .. } => {}
            Input::SwitchA { select } => slots[select as usize].switch_a = Some(channel as u8),
            Input::SwitchB { select } => slots[select as usize].switch_b = Some(channel as u8),
        }
        channel += 1;
    }
    let mut n = 0;
    while n < AGAIN.len() {
        let slot = &mut slots[SWITCH_INPUTS as usize + n];
        if let Some(channel) = AGAIN[n]
            && let Input::SwitchB { select } = CHANNELS[channel].input
        {
            *slot = Slot { select, switch_a: None, switch_b: Some(channel as u8) };
        }
        n += 1;
    }
    slots
};

/// The last slot that reads one of `count` channels from `first` on.
const fn last_reading(first: usize, count: usize) -> u8 {
    let mut last = 0;
    let mut channel = first;
    while channel < first + count {
        if let Input::SwitchA { select } | Input::SwitchB { select } = CHANNELS[channel].input
            && select > last
        {
            last = select;
        }
        channel += 1;
    }
    last
}

/// The slot in which a job runs, after its readings.
pub const fn slot_of(job: Job) -> u8 {
    let array = last_reading(ARRAY, ARRAY_COUNT) + 1;
    match job {
        Job::Forces => last_reading(FSR, FSR_COUNT),
        Job::ArrayBegins => array,
        Job::MlpDecides => array + ARRAY_SHARES - 1,
        Job::Think => 19,
        Job::Save => 21,
        Job::EndOfCycle => FRAMES_PER_SLOW_FRAME - 1,
    }
}

/// State of the select lines in this slot, 0 to 15. A slot above 24 is taken modulo 25.
pub const fn select_of_slot(slot: u8) -> u8 {
    SCHEDULE[(slot % FRAMES_PER_SLOW_FRAME) as usize].select
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_switched_channel_is_read_where_its_input_is_shown() {
        for (n, channel) in CHANNELS.iter().enumerate() {
            let reads = |slot: &&Slot| [slot.switch_a, slot.switch_b].contains(&Some(n as u8));
            let times = SCHEDULE.iter().filter(reads).count();
            match channel.input {
                Input::Direct { .. } => assert_eq!(times, 0, "{}", channel.name),
                Input::SwitchA { select } | Input::SwitchB { select } => {
                    let expected = if [MYO_FLEXOR, MYO_EXTENSOR].contains(&n) { 3 } else { 1 };
                    assert_eq!(times, expected, "{}", channel.name);
                    assert!(
                        SCHEDULE.iter().filter(reads).all(|slot| slot.select == select),
                        "{}",
                        channel.name
                    );
                }
            }
        }
    }

    #[test]
    fn the_muscles_are_read_at_most_13_slots_apart() {
        for muscle in [MYO_FLEXOR, MYO_EXTENSOR] {
            let reads = (0..2 * SLOTS).filter(|n| SCHEDULE[n % SLOTS].switch_b == Some(muscle as u8));
            let reads: std::vec::Vec<_> = reads.collect();
            assert!(reads.windows(2).all(|two| two[1] - two[0] <= 13), "{reads:?}");
        }
    }

    #[test]
    fn a_job_comes_after_its_readings_and_before_the_cycle_ends() {
        for (job, first, count) in [(Job::Forces, FSR, FSR_COUNT), (Job::ArrayBegins, ARRAY, ARRAY_COUNT)] {
            let later = SCHEDULE[usize::from(slot_of(job)) + 1..].iter();
            let mut read_later = later.flat_map(|slot| [slot.switch_a, slot.switch_b]).flatten();
            assert!(read_later.all(|n| !(first..first + count).contains(&usize::from(n))), "{job:?}");
        }
        let jobs = [Job::Forces, Job::ArrayBegins, Job::MlpDecides, Job::Think, Job::Save, Job::EndOfCycle];
        assert!(jobs[1..].is_sorted_by_key(|&job| slot_of(job)));
        assert_eq!(usize::from(slot_of(Job::EndOfCycle)), SLOTS - 1);
        for job in [Job::Think, Job::Save] {
            assert_eq!(SCHEDULE[usize::from(slot_of(job))].switch_b, None);
        }
    }
}
