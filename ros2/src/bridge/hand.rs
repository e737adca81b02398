//! A line and its topics: what comes up is published, a gripper command goes down.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use crate::hand::{self, Grasp, Health, Object, Step, ceiling_mn, header};
use crate::key::Domain;
use crate::message::{DiagnosticArray, GripperCommand, JointState, Margin, Slip, Tactile, Word};
use tenax_frames::link::{Board, Client};
use tenax_hal_shim::channel::SLOW_HZ;
use tenax_hal_shim::wire::{Answer, Down, Refusal, Senses, Slow, Up};
use zenoh::Session;

use super::network::{Graph, Publisher, now_ns};

const ANSWER_WITHIN: Duration = Duration::from_millis(500);
const AGAIN_AFTER: Duration = Duration::from_millis(500);
const DIAGNOSE_EVERY: Duration = Duration::from_secs(1);
const SESSIONS_MAX: u32 = 3;

#[derive(Clone, Debug)]
pub struct Hand {
    pub name: String,
    pub board: Board,
    /// Gap of the open hand, m.
    pub range_m: f64,
}

/// The newest command of the network, until the line's thread takes it.
type Desk = Arc<Mutex<Option<GripperCommand>>>;

struct Topics<'a> {
    joints: Publisher<'a>,
    slip: Publisher<'a>,
    margin: Publisher<'a>,
    tactile: Publisher<'a>,
    object: Publisher<'a>,
    diagnostics: Publisher<'a>,
}

/// Bridges a hand until `stop`, or the session is closed. A line that ends is opened again, wherever the board is plugged in then.
pub fn bridge(
    session: &Session,
    domain: Domain,
    id: u32,
    hand: &Hand,
    stop: &AtomicBool,
) -> anyhow::Result<()> {
    let name = &hand.name;
    let mut graph = Graph::new(session, domain, id, &format!("tenax_{name}"))?;
    let mut topics = Topics {
        joints: graph.publisher::<JointState>(&format!("/{name}/joint_states"))?,
        slip: graph.publisher::<Slip>(&format!("/{name}/slip"))?,
        margin: graph.publisher::<Margin>(&format!("/{name}/margin"))?,
        tactile: graph.publisher::<Tactile>(&format!("/{name}/tactile"))?,
        object: graph.publisher::<Word>(&format!("/{name}/object"))?,
        diagnostics: graph.publisher::<DiagnosticArray>("/diagnostics")?,
    };
    let desk = Desk::default();
    let heard = Arc::clone(&desk);
    let _subscription =
        graph.subscription::<GripperCommand>(&format!("/{name}/gripper_command"), move |command| {
            *heard.lock().unwrap_or_else(PoisonError::into_inner) = Some(command);
        })?;
    let (mut health, mut board) = (Health::default(), hand.board.clone());
    while !stop.load(Ordering::Relaxed) {
        match board.open() {
            Ok((client, moved)) => {
                moved.into_iter().for_each(|words| eprintln!("/{name}: {words}"));
                (health.gone, health.line) = (None, board.line.to_string());
                let mut attendant = Attendant {
                    client,
                    name,
                    topics: &mut topics,
                    desk: &desk,
                    health: &mut health,
                    senses: None,
                    range_m: hand.range_m,
                    object: (Object::default(), "", SLOW_HZ),
                    grasp: None,
                    sent: None,
                    sessions: 0,
                };
                let why = attendant.attend(stop)?;
                health.gone = Some(why);
            }
            Err(error) => health.gone = Some(format!("{error:#}")),
        }
        // No command waits for a line that comes back.
        *desk.lock().unwrap_or_else(PoisonError::into_inner) = None;
        topics.diagnostics.publish(&health.diagnostics(name, now_ns()))?;
        thread::sleep(AGAIN_AFTER);
    }
    Ok(())
}

struct Attendant<'a, 'b> {
    client: Client,
    name: &'a str,
    topics: &'a mut Topics<'b>,
    desk: &'a Desk,
    health: &'a mut Health,
    senses: Option<Senses>,
    range_m: f64,
    /// The object, the word that was published last, and slow frames since then.
    object: (Object, &'static str, u32),
    grasp: Option<Grasp>,
    sent: Option<(u16, Down)>,
    /// Sessions that were asked for since the last command came.
    sessions: u32,
}

impl Attendant<'_, '_> {
    /// Serves the line until it ends; the reason. Fails if nothing can be published any more.
    fn attend(&mut self, stop: &AtomicBool) -> anyhow::Result<String> {
        let mut diagnosed = Instant::now();
        while !stop.load(Ordering::Relaxed) {
            let _asked = self.client.keep_streaming(false);
            match self.client.next_message() {
                Ok(Some(heard)) => self.hear(heard.received.message)?,
                Ok(None) => {}
                Err(error) => return Ok(format!("the line ended ({error})")),
            }
            if diagnosed.elapsed() >= DIAGNOSE_EVERY {
                diagnosed = Instant::now();
                let counts = self.client.counts();
                self.health.count(counts.missed, counts.bad_frames, now_ns());
                self.topics.diagnostics.publish(&self.health.diagnostics(self.name, now_ns()))?;
            }
        }
        Ok("the bridge was ended".to_owned())
    }

    fn hear(&mut self, message: Up) -> anyhow::Result<()> {
        match message {
            Up::Slow(slow) => {
                // The motor first.
                self.command(&slow);
                self.publish(&slow)?;
            }
            Up::Senses(senses) => self.senses = Some(senses),
            Up::Counters(counters) => self.health.counters = Some(counters),
            Up::About(about) | Up::Answer { answer: Answer::About(about), .. } => {
                self.health.about = Some(about)
            }
            Up::Answer { of, answer: Answer::Refused(refusal), .. } => self.refused(of, refusal),
            _ => {}
        }
        Ok(())
    }

    fn publish(&mut self, slow: &Slow) -> anyhow::Result<()> {
        let head = || header(self.name, now_ns());
        let senses = self.senses.as_ref();
        self.topics.joints.publish(&hand::joint_state(head(), slow, senses, self.range_m))?;
        self.topics.slip.publish(&hand::slip(head(), slow))?;
        self.topics.margin.publish(&hand::margin(head(), slow))?;
        self.topics.tactile.publish(&hand::tactile(head(), slow, senses))?;
        // At each change, and each second for who comes later.
        let (object, said, since) = &mut self.object;
        let word = object.follow(slow);
        *since += 1;
        if word != *said || *since >= SLOW_HZ {
            (*said, *since) = (word, 0);
            self.topics.object.publish(&Word { data: word.to_owned() })?;
        }
        Ok(())
    }

    fn command(&mut self, slow: &Slow) {
        let command = self.desk.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(command) = command {
            let ceiling = self.health.about.as_ref().and_then(ceiling_mn);
            self.sessions = 0;
            match Grasp::of(&command, ceiling) {
                Ok(grasp) => {
                    self.grasp = Some(grasp);
                    self.health.command = "goes on".to_owned();
                }
                // The one that goes on is not what is wanted any more.
                Err(why) => self.over(why),
            }
        }
        let load_mn = slow.forces.map(|forces| forces.load_mn);
        match self.grasp.as_mut().map(|grasp| grasp.step(load_mn)) {
            None => {}
            Some(Step::Over(why)) => self.over(why),
            Some(Step::Send(down)) => self.send(down),
        }
    }

    fn send(&mut self, down: Down) {
        match self.client.send(&down) {
            Ok(number) => self.sent = Some((number, down)),
            Err(error) => self.over(&format!("{error:#}")),
        }
    }

    /// The board has the last word. Without a session one is opened, and the step is sent once more.
    fn refused(&mut self, of: u16, refusal: Refusal) {
        let Some((_, down)) = self.sent.take_if(|(number, _)| *number == of) else { return };
        if matches!(refusal, Refusal::NoSession | Refusal::Replayed) && self.sessions < SESSIONS_MAX {
            self.sessions += 1;
            if let Ok(true) = self.client.open_session(ANSWER_WITHIN) {
                return self.send(down);
            }
        }
        self.over(&format!("refused by the board: {refusal:?}"));
    }

    fn over(&mut self, why: &str) {
        self.grasp = None;
        self.health.command = why.to_owned();
    }
}
