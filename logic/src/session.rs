//! Replay guard: refuses a recorded command. A peer gives back a number that the board offers once; then the
//! numbers of its frames only rise, by at most [`WINDOW`], and the session ends before they come round.
//! [`arming`](crate::arming) protects against other writers. A trusted line keeps only the window.

use tenax_hal_shim::wire::Refusal;

pub const WINDOW: u16 = 1_024;
const NUMBERS_MAX: u16 = u16::MAX - 2 * WINDOW;

#[derive(Clone, Debug, Default)]
pub struct Session {
    pool: u32,
    offered: Option<u32>,
    is_open: bool,
    last: Option<u16>,
    used: u16,
}

impl Session {
    pub fn stir(&mut self, noise: u32) {
        self.pool = mixed(self.pool.rotate_left(5) ^ noise);
    }

    pub fn offer(&mut self) -> u32 {
        self.pool = mixed(self.pool.wrapping_add(0x9E37_79B9));
        let nonce = mixed(self.pool ^ 0x5EED_0FF1);
        self.offered = Some(nonce);
        nonce
    }

    pub fn open(&mut self, nonce: u32, sequence: u16) -> Result<(), Refusal> {
        if self.offered.take() != Some(nonce) {
            return Err(Refusal::Replayed);
        }
        *self = Self { pool: self.pool, offered: None, is_open: true, last: Some(sequence), used: 0 };
        Ok(())
    }

    pub fn admit(&mut self, sequence: u16, trusted: bool) -> Result<(), Refusal> {
        if !trusted && !self.is_open {
            return Err(Refusal::NoSession);
        }
        if self.advance(sequence) { Ok(()) } else { Err(Refusal::Replayed) }
    }

    pub fn read(&mut self, sequence: u16) {
        if self.is_open {
            self.advance(sequence);
        }
    }

    fn advance(&mut self, sequence: u16) -> bool {
        let Some(last) = self.last else {
            self.last = Some(sequence);
            return true;
        };
        let ahead = sequence.wrapping_sub(last);
        if ahead == 0 || ahead > WINDOW {
            return false;
        }
        self.last = Some(sequence);
        self.used = self.used.saturating_add(ahead);
        self.is_open &= self.used < NUMBERS_MAX;
        true
    }
}

const fn mixed(mut number: u32) -> u32 {
    number ^= number >> 16;
    number = number.wrapping_mul(0x85EB_CA6B);
    number ^= number >> 13;
    number = number.wrapping_mul(0xC2B2_AE35);
    number ^ number >> 16
}

#[cfg(test)]
mod tests {
    use super::*;

    fn open(session: &mut Session, sequence: u16) -> u32 {
        session.stir(7);
        let nonce = session.offer();
        assert_eq!(session.open(nonce, sequence), Ok(()));
        nonce
    }

    #[test]
    fn a_recorded_session_is_refused_whole() {
        let mut session = Session::default();
        let nonce = open(&mut session, 10);
        assert_eq!(session.admit(11, false), Ok(()));
        assert_eq!(session.admit(11, false), Err(Refusal::Replayed));
        assert_eq!(session.open(nonce, 10), Err(Refusal::Replayed));
        let other = session.offer();
        assert_ne!(other, nonce);
        assert_eq!(session.open(nonce, 10), Err(Refusal::Replayed));
        assert_eq!(session.open(other, 10), Err(Refusal::Replayed), "a wrong guess voids the offer");
        assert_eq!(session.admit(11, false), Err(Refusal::Replayed), "the session before goes on");
        assert_eq!(session.admit(12, false), Ok(()));
    }

    #[test]
    fn the_window_is_ahead_only_and_survives_the_wrap() {
        let mut session = Session::default();
        open(&mut session, u16::MAX - 1);
        for (sequence, admitted) in
            [(u16::MAX, true), (1, true), (0, false), (1 + WINDOW, true), (2 + 2 * WINDOW, false)]
        {
            assert_eq!(session.admit(sequence, false).is_ok(), admitted, "{sequence}");
        }
    }

    #[test]
    fn reading_uses_numbers_up_and_a_session_ends_before_they_come_round() {
        let mut session = Session::default();
        open(&mut session, 0);
        session.read(500);
        assert_eq!(session.admit(400, false), Err(Refusal::Replayed));
        let mut sequence = 500u16;
        let mut last = Ok(());
        for _ in 0..u16::MAX {
            sequence = sequence.wrapping_add(1);
            last = session.admit(sequence, false);
            if last.is_err() {
                break;
            }
        }
        assert_eq!(last, Err(Refusal::NoSession));
        assert!(sequence < u16::MAX - WINDOW, "what was recorded at its beginning is not ahead: {sequence}");
    }

    #[test]
    fn a_trusted_line_needs_no_session_and_has_its_window() {
        let mut session = Session::default();
        assert_eq!(session.admit(700, true), Ok(()));
        assert_eq!(session.admit(700, true), Err(Refusal::Replayed));
        assert_eq!(session.admit(701, true), Ok(()));
        let nonce = session.offer();
        assert_eq!(session.open(nonce, 0), Ok(()), "a peer that began anew says so");
        assert_eq!(session.admit(1, true), Ok(()));
    }
}
