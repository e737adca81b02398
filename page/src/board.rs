//! A board's line over Web Serial, or a recording of one that plays.

use serde_json::json;
use tenax_frames::link::Captured;
use tenax_frames::play::{Player, Reel, Told};
use tenax_frames::record::Tape;
use tenax_hal_shim::wire::Down;
use tenax_line::view::View;

use crate::talker::Talker;
use crate::unpack::unpacked;

#[derive(Default)]
pub struct Board {
    pub talker: Talker,
    up: Vec<u8>,
    player: Option<Player>,
    clock_s: f64,
    /// The recording that goes on, and ns since 1970 at the clock's 0.
    tape: Option<(Tape<Vec<u8>>, f64)>,
}

impl Board {
    pub fn connected() -> Self {
        let mut board = Self::default();
        board.talker.view.tell(json!({ "place": "Web Serial", "missed": 0, "bad_frames": 0 }));
        board.talker.view.open();
        // Who it is; whether its last run ended in a fault.
        board.talker.ask(Down::About);
        board.talker.ask(Down::Last(0));
        board
    }

    /// A file's bytes. Fails if they are no board's line.
    pub fn recorded(bytes: Vec<u8>, is_mcap: bool) -> Result<Self, String> {
        let name = if is_mcap { "recording.mcap" } else { "line.bin" };
        let bytes = if is_mcap { unpacked(&bytes) } else { bytes };
        let (captured, _) = Captured::of(name, bytes).map_err(|error| format!("{error:#}"))?;
        let mut board = Self { player: Some(Player::new(Reel::of(captured), 0.0)), ..Self::default() };
        board.talker.view.tell(json!({ "place": "a recording", "missed": 0, "bad_frames": 0 }));
        Ok(board)
    }

    pub const fn is_live(&self) -> bool {
        self.player.is_none()
    }

    pub fn hear(&mut self, bytes: &[u8]) {
        self.up.extend_from_slice(bytes);
    }

    /// Goes on to an instant of the page's clock, s; bytes for the line.
    pub fn go_on(&mut self, clock_s: f64) -> Vec<u8> {
        let Some(player) = &mut self.player else {
            self.clock_s = clock_s;
            let up = std::mem::take(&mut self.up);
            if let Some((tape, zero_ns)) = &mut self.tape {
                // Memory is never full before the page is gone.
                let _written = tape.line(&up, (*zero_ns + clock_s * 1e9) as u64);
            }
            return self.talker.go_on(&up, clock_s);
        };
        if self.clock_s == 0.0 {
            player.control("0", clock_s, &mut |told| shown(&mut self.talker.view, told));
        }
        self.clock_s = clock_s;
        while player.due_s(clock_s) == Some(0.0) {
            player.step(clock_s, &mut |told| shown(&mut self.talker.view, told));
        }
        Vec::new()
    }

    /// Begins a recording, by this clock of the page.
    pub fn record(&mut self, now_ms: u64) -> Result<(), String> {
        let tape = Tape::new(Vec::new(), now_ms * 1_000_000).map_err(|error| error.to_string())?;
        self.tape = Some((tape, now_ms as f64 * 1e6 - self.clock_s * 1e9));
        // Its metadata name the board.
        self.talker.ask(Down::About);
        Ok(())
    }

    /// Ends the recording; the file's bytes (MCAP).
    pub fn recording(&mut self) -> Vec<u8> {
        self.tape.take().and_then(|(tape, _)| tape.finish().ok()).unwrap_or_default()
    }

    pub fn control(&mut self, line: &str) {
        if let Some(player) = &mut self.player {
            player.control(line, self.clock_s, &mut |told| shown(&mut self.talker.view, told));
        }
    }
}

fn shown(view: &mut View, told: Told) -> bool {
    match told {
        Told::Message(heard) => view.hear(&heard),
        Told::At(playing) => view.tell(json!({ "playing": playing })),
        Told::Again => view.begin_anew(),
    }
    true
}
