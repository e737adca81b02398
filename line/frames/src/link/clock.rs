//! Time in a file: it goes on where the board's 32-bit frame counter wraps (after 24.9 days), and where the board starts again.

use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::wire::Up;

/// Frames that a message may be older than the newest, 2 s.
const LATE_MAX: i64 = 2 * FRAME_HZ as i64;
/// Frames that may be missing where nobody knows how much time went by, 10 min.
const GAP_MAX: i64 = 600 * FRAME_HZ as i64;
const FRAME_NS: i64 = 1_000_000_000 / FRAME_HZ as i64;

#[derive(Clone, Debug, Default)]
pub struct Clock {
    /// The newest frame, as the board counts: `u32::MAX` between its start and its first. None before both.
    last: Option<u32>,
    /// Whether the next frame is the first after a start.
    is_first: bool,
    /// The newest frame, and that from which the board counts, in frames of the file.
    newest: i64,
    start: i64,
    /// The file's time 0 by the clock of the computer that heard the line, ns since 1970.
    zero_ns: Option<i64>,
    /// When the newest message came, ns since 1970.
    came_ns: Option<u64>,
}

impl Clock {
    /// Takes a message and the instant at which it came, ns since 1970, if that is known.
    /// True: the board has started again, and its first message was missed.
    pub fn hear(&mut self, message: &Up, came_ns: Option<u64>) -> bool {
        let (frame, is_hello) = match message {
            // Before its first frame.
            Up::Hello { .. } => (u32::MAX, true),
            Up::Slow(slow) => (slow.frame, false),
            Up::Raw(raw) => (raw.first.wrapping_add(raw.frames().len().saturating_sub(1) as u32), false),
            Up::Senses(senses) => (senses.frame, false),
            Up::Answer { frame, .. } if self.last.is_none() => (*frame, false),
            _ => return false,
        };
        let of_host = came_ns.zip(self.zero_ns).map(|(came, zero)| (came as i64 - zero) / FRAME_NS - 1);
        let since_start = if is_hello { -1 } else { i64::from(frame) };
        let ahead = if self.is_first { i64::from(frame.wrapping_add(1)) } else { self.ahead(frame) };
        let gap_max = GAP_MAX + 2 * of_host.map_or(0, |now| (now - self.newest).max(0));
        let is_lost = !self.is_first && !(-LATE_MAX..=gap_max).contains(&ahead);
        let is_restart = self.last.is_some() && (is_hello || is_lost);
        match self.last {
            None => self.newest = since_start,
            Some(_) if is_restart => {
                self.newest = of_host.unwrap_or_default().max(self.newest + 1);
                self.start = self.newest - since_start;
            }
            Some(_) if ahead <= 0 => return false,
            Some(_) => self.newest += ahead,
        }
        (self.last, self.is_first) = (Some(frame), is_hello);
        self.zero_ns = self.zero_ns.or(came_ns.map(|came| came as i64 - (self.newest + 1) * FRAME_NS));
        is_restart && !is_hello
    }

    /// Time from the message before to one that comes now, s; 0 where that is not known.
    pub fn silence_s(&mut self, came_ns: Option<u64>) -> f64 {
        let before_ns = self.came_ns;
        self.came_ns = came_ns.or(before_ns);
        came_ns.zip(before_ns).map_or(0.0, |(now, before)| now.saturating_sub(before) as f64 / 1e9)
    }

    /// The newest frame, as the board counts.
    pub const fn last(&self) -> Option<u32> {
        self.last
    }

    /// A frame of the board in frames of the file.
    pub fn at(&self, frame: u32) -> i64 {
        (self.newest + self.ahead(frame).clamp(-LATE_MAX, LATE_MAX)).max(-1)
    }

    /// End of a frame, s of the file: the board's time until it starts again.
    pub fn seconds(&self, frame: u32) -> f64 {
        (self.at(frame) + 1) as f64 / f64::from(FRAME_HZ)
    }

    /// End of a frame, s since the board's start.
    pub fn board_seconds(&self, frame: u32) -> f64 {
        (self.at(frame) - self.start + 1) as f64 / f64::from(FRAME_HZ)
    }

    /// End of a frame, ns since 1970.
    pub fn ns(&self, frame: u32) -> u64 {
        (self.zero_ns.unwrap_or_default() + (self.at(frame) + 1) * FRAME_NS).max(0) as u64
    }

    fn ahead(&self, frame: u32) -> i64 {
        i64::from(self.last.map_or(0, |last| frame.wrapping_sub(last) as i32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_hal_shim::channel::{COUNT, PVDF_COUNT};
    use tenax_hal_shim::wire::Senses;

    const SECOND: u64 = 1_000_000_000;

    fn hello() -> Up {
        Up::Hello { frame_hz: 2_000, after: None }
    }

    fn senses(frame: u32) -> Up {
        Up::Senses(Senses { frame, samples: [0; COUNT], films: [0; PVDF_COUNT] })
    }

    #[test]
    fn time_goes_on_over_wraps_resets_and_missed_starts() {
        let mut clock = Clock::default();
        let mut at_s = |message: &Up, frame, came_s: Option<u64>| {
            let missed = clock.hear(message, came_s.map(|s| s * SECOND));
            (missed, clock.seconds(frame), clock.board_seconds(frame))
        };
        // A board that has run for 24.9 days; late messages go back, and not far.
        let wrap_s = (1_u64 << 32) as f64 / 2_000.0;
        assert_eq!(at_s(&senses(u32::MAX), u32::MAX, Some(1_000)), (false, wrap_s, wrap_s));
        assert_eq!(at_s(&senses(1_999), 1_999, Some(1_001)), (false, wrap_s + 1.0, wrap_s + 1.0));
        assert_eq!(at_s(&senses(999), 999, Some(1_001)), (false, wrap_s + 0.5, wrap_s + 0.5));
        // It is reset, and comes back 3 s later.
        assert_eq!(at_s(&hello(), 1_999, Some(1_004)), (false, wrap_s + 5.0, 1.0));
        assert_eq!(at_s(&senses(39_999), 39_999, Some(1_024)), (false, wrap_s + 24.0, 20.0));
        // Once more, unheard: it has run for 1 s when it is heard again, 6 s later.
        assert_eq!(at_s(&senses(1_999), 1_999, Some(1_030)), (true, wrap_s + 30.0, 1.0));
        // A gap as long as the host says is none of the board's.
        assert_eq!(at_s(&senses(4_001_999), 4_001_999, Some(3_030)), (false, wrap_s + 2_030.0, 2_001.0));
    }

    #[test]
    fn bytes_without_a_host_have_the_boards_time_and_no_step_back() {
        let mut clock = Clock::default();
        assert!(!clock.hear(&hello(), None) && !clock.hear(&senses(19_999), None));
        assert_eq!(clock.seconds(19_999), 10.0);
        assert!(!clock.hear(&hello(), None));
        assert_eq!((clock.seconds(0), clock.board_seconds(0)), (10.001, 0.0005));
        // A start, and a board that counts from elsewhere, over the wrap.
        let mut clock = Clock::default();
        assert!([hello(), senses(u32::MAX - 999), senses(999)].iter().all(|own| !clock.hear(own, None)));
        assert_eq!((clock.at(u32::MAX - 999), clock.at(999)), ((1 << 32) - 1_000, (1 << 32) + 999));
        // From 17 days, where the counter's difference is positive.
        let mut clock = Clock::default();
        assert!(!clock.hear(&senses(3_000_000_000), None) && clock.hear(&senses(24), None));
        assert_eq!(clock.seconds(24), 1_500_000.001);
    }
}
