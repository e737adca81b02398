//! A scene under the host's board, played by a person: two hands on the same seed, the second with a control in the reflex's place.

use std::collections::VecDeque;

use serde_json::{Value, json};
use tenax_hal_shim::channel::{FRAME_HZ, SCAN_HZ};
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::Down;
use tenax_scene::act::KEYS;
use tenax_scene::plant::{Pins, Plant};
use tenax_scene::{Act, SceneFile, World, builtin};
use tenax_sim::board::kept::Set;
use tenax_sim::board::simulated::{Grips, Stepper, frames_in, seconds_of};
use tenax_sim::board::{Recorder, Run};

use crate::talker::Talker;

/// Rows of the world's trace for each that the page draws: 50 a second.
const ROWS: usize = 4;
/// How long a person presses the button, scans: 0.3 s.
const PRESSED: u32 = 3 * SCAN_HZ / 10;

/// The text of a scene that ships, or of the one that stays on.
fn file(name: &str) -> Result<SceneFile, String> {
    let (place, text) = builtin::find(name).ok_or_else(|| format!("no scene is called {name}"))?;
    SceneFile::parse(&text, &place).map_err(|error| error.to_string())
}

fn set(file: &SceneFile, seed: u64, settings: &[(String, i32)]) -> Result<Set<World>, String> {
    Set::new(World::new(file, seed), settings).map_err(|why| why.to_string())
}

/// Name, title and length (s) of each scene.
pub fn scenes() -> Result<Value, String> {
    let names = std::iter::once("bench").chain(builtin().iter().map(|(name, _)| *name));
    let rows: Result<Vec<Value>, String> =
        names.map(|name| file(name).map(|scene| json!([name, scene.title, scene.duration_s()]))).collect();
    Ok(Value::Array(rows?))
}

/// A person at the button and at the other end of the line.
struct Manned {
    set: Set<World>,
    /// Scans for which the button is still pressed. What waits for the line is sent when it is let go.
    pressed: u32,
    down: VecDeque<u8>,
}

impl Plant for Manned {
    tenax_scene::put_around!(set);

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.pressed = self.pressed.saturating_sub(1);
        self.set.scan(drive)
    }

    fn line_bytes(&mut self) -> Vec<u8> {
        // About as fast as the line: 11 bytes a scan.
        let sent = if self.pressed > 0 { 0 } else { self.down.len().min(11) };
        self.down.drain(..sent).collect()
    }

    fn button(&self) -> bool {
        self.pressed > 0 || self.set.button()
    }
}

struct Hand {
    plant: Manned,
    board: Stepper,
    rows: usize,
    needs_n: f64,
    carried: bool,
}

impl Hand {
    fn new(set: Set<World>, grips: Grips, line: &mut dyn Recorder) -> Self {
        let plant = Manned { set, pressed: 0, down: VecDeque::new() };
        let board = Stepper::new(&plant, grips, line);
        Self { plant, board, rows: 0, needs_n: 0.0, carried: false }
    }

    /// False: the board was reset.
    fn frame(&mut self, line: &mut dyn Recorder) -> bool {
        self.board.frame(&mut self.plant, line)
    }

    /// Time (s), speed of the object over the pad (mm/s), need and grip (N), margin (N).
    fn trace(&mut self) -> Vec<Value> {
        let mut points = Vec::new();
        for row in self.plant.set.plant.take_trace() {
            self.rows += 1;
            self.carried |= row.needed_n > 0.0;
            self.needs_n = row.needed_n;
            if self.rows.is_multiple_of(ROWS) {
                let mm = |value: f64| (value * 1e3).round() / 1e3;
                let margin = (row.needed_n > 0.0).then(|| mm(row.margin_n));
                points.push(json!([
                    mm(row.t_s),
                    mm(row.slide_mm_s.abs()),
                    mm(row.needed_n),
                    mm(row.grip_n),
                    margin,
                    mm(row.stuck_part)
                ]));
            }
        }
        points
    }

    fn told(&mut self) -> Value {
        let trace = self.trace();
        let world = &self.plant.set.plant;
        let (pose, truth) = (world.pose(), world.truth());
        let mean = |sum: f64| (truth.carried_s > 0.0).then(|| sum / truth.carried_s);
        json!({
            "trace": trace,
            "opening_mm": pose.opening_mm,
            "hand_mm": pose.hand_mm,
            "object_mm": pose.object_mm,
            "pitch_rad": pose.pitch_rad,
            "width_mm": pose.width_mm,
            "mass_kg": pose.mass_kg,
            "mu_s": pose.mu_s,
            "carried": self.carried,
            "slips": truth.slips.iter().filter(|slip| !slip.meant).count(),
            "slipped_mm": truth.slip_distance_mm,
            "peak_n": truth.peak_grip_n,
            "mean_n": mean(truth.carried_ns),
            "beyond_n": mean(truth.beyond_need_ns),
            "dropped": truth.dropped || truth.left_behind,
            "crushed": truth.crushed_at_s.is_some(),
            "broken": truth.broken_at_s.is_some(),
        })
    }
}

pub struct Bench {
    file: SceneFile,
    seed: u64,
    settings: Vec<(String, i32)>,
    hand: Hand,
    tape: Vec<u8>,
    beside: Option<Hand>,
    pub talker: Talker,
    frames: u32,
    until: u32,
}

impl Bench {
    /// Fails on an unknown scene, or a setting that is none or out of its range.
    pub fn new(name: &str, seed: u64, settings: Vec<(String, i32)>, beside: &str) -> Result<Self, String> {
        let file = file(name)?;
        let mut tape = Vec::new();
        let all = Grips::Reflex(DetectorSet::ALL);
        let hand = Hand::new(set(&file, seed, &settings)?, all, &mut tape);
        let until = frames_in(file.duration_s());
        let mut bench = Self {
            file,
            seed,
            settings,
            hand,
            tape,
            beside: None,
            talker: Talker::default(),
            frames: 0,
            until,
        };
        bench.stand_beside(beside)?;
        let keys: Vec<_> = KEYS.iter().map(|(key, what, _)| (*key, *what)).collect();
        bench
            .talker
            .view
            .tell(json!({ "place": format!("bench: {name}"), "bench": keys, "missed": 0, "bad_frames": 0 }));
        Ok(bench)
    }

    /// Puts a control beside the hand, from the scene's beginning: `reflex off`, `constant grip` of a force (N), or none.
    fn stand_beside(&mut self, control: &str) -> Result<(), String> {
        let grips = match control.split_once(' ').unwrap_or((control, "")) {
            ("" | "none", _) => return Ok(()),
            ("off", _) => Grips::Reflex(DetectorSet::NONE),
            ("constant", newtons) => Grips::Constant(match newtons.parse() {
                Ok(newtons) => newtons,
                Err(_) => self.mean_n()?,
            }),
            _ => return Err(format!("no control is called {control}")),
        };
        self.beside = Some(Hand::new(self.set()?, grips, &mut ()));
        Ok(())
    }

    /// Mean grip force while the reflex carries the object, over the whole scene, N.
    fn mean_n(&self) -> Result<f64, String> {
        let mut own = Hand::new(self.set()?, Grips::Reflex(DetectorSet::ALL), &mut ());
        // A scene that stays on has no mean force: what a person does in it is not known.
        for _ in 0..self.until.min(120 * FRAME_HZ) {
            own.frame(&mut ());
            own.plant.set.plant.take_trace();
        }
        let truth = own.plant.set.plant.truth();
        Ok(if truth.carried_s > 0.0 { truth.carried_ns / truth.carried_s } else { 10.0 })
    }

    fn set(&self) -> Result<Set<World>, String> {
        set(&self.file, self.seed, &self.settings)
    }

    /// A setting is changed with consent: the button is pressed before.
    pub fn command(&mut self, command: Down) {
        self.hand.plant.pressed = PRESSED;
        self.talker.ask(command);
    }

    pub fn act(&mut self, words: &str) -> Result<(), String> {
        if words == "button" {
            self.hand.plant.pressed = PRESSED;
        } else {
            let act: Act = words.parse().map_err(|()| format!("nobody can do {words} here"))?;
            let hands = std::iter::once(&mut self.hand).chain(&mut self.beside);
            hands.for_each(|hand| hand.plant.act(act));
        }
        self.talker.view.say(&format!("at the bench: {words}"));
        Ok(())
    }

    /// Goes on by so many frames, at most to the scene's end.
    pub fn advance(&mut self, frames: u32) {
        for _ in 0..frames.min(self.until - self.frames) {
            let goes_on = self.hand.frame(&mut self.tape);
            if let Some(beside) = &mut self.beside {
                beside.frame(&mut ());
            }
            self.frames += 1;
            if !goes_on {
                self.until = self.frames;
                break;
            }
        }
        let line = std::mem::take(&mut self.tape);
        self.hand.plant.down.extend(self.talker.go_on(&line, seconds_of(self.frames)));
    }

    pub fn told(&mut self) -> Value {
        let [now_s, of_s] = [self.frames, self.until].map(seconds_of);
        json!({
            "now_s": now_s, "of_s": of_s, "over": self.frames == self.until,
            "hand": self.hand.told(), "beside": self.beside.as_mut().map(Hand::told),
        })
    }
}

/// Everything that the board decided in a scene, as the bench runs it when nobody touches it: for the golden hashes.
pub fn run(name: &str, seed: u64) -> Result<(Run, World), String> {
    let (file, mut run) = (file(name)?, Run::default());
    let mut hand = Hand::new(set(&file, seed, &[])?, Grips::Reflex(DetectorSet::ALL), &mut run);
    for _ in 0..frames_in(file.duration_s()) {
        if !hand.frame(&mut run) {
            break;
        }
    }
    run.summary = hand.board.end();
    Ok((run, hand.plant.set.plant))
}
