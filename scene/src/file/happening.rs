//! Events of a scene, as its file says: scores are counted by them.

use super::SceneFile;

/// A knock is over after this many times its decay: then it is below a hundredth of its peak.
const KNOCK_DECAYS: f64 = 5.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Happening {
    Pour,
    Move,
    Disturb,
}

impl SceneFile {
    pub fn happenings(&self) -> Vec<(f64, f64, Happening)> {
        let from = |at_s: f64, for_s: f64, what| (at_s, at_s + for_s, what);
        let fills = self.fill.iter().map(|fill| from(fill.at_s.get(), fill.for_s.get(), Happening::Pour));
        let moves = self.moves.iter().map(|go| from(go.at_s.get(), go.for_s.get(), Happening::Move));
        let sweeps = self.sweep.iter().map(|go| from(go.at_s.get(), go.for_s.get(), Happening::Move));
        let knocks = self.knock.iter().map(|knock| {
            from(knock.at_s.get(), KNOCK_DECAYS * knock.decay_ms.get() / 1e3, Happening::Disturb)
        });
        let swings = self.swing.iter().map(|swing| {
            let for_s = f64::from(swing.cycles.get()) / swing.rate_hz.get();
            from(swing.at_s.get(), for_s, Happening::Disturb)
        });
        fills.chain(moves).chain(sweeps).chain(knocks).chain(swings).collect()
    }
}
