//! A line and its topics: what comes up is published, a gripper command goes down.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use crate::hand::{self, Grasp, Health, Object, Step, ceiling_mn, header};
use crate::key::{Domain, Role};
use crate::message::{
    DiagnosticArray, Gripper, GripperCommand, JointState, Margin, Message, Slip, Tactile, Word,
};
use tenax_frames::link::{Board, Client};
use tenax_hal_shim::channel::SLOW_HZ;
use tenax_hal_shim::wire::{Answer, Down, Refusal, Senses, Slow, Up};
use zenoh::Session;

use super::action::{ABORTED, Action, SUCCEEDED};
use super::network::{Graph, Publisher, now_ns};

const ANSWER_WITHIN: Duration = Duration::from_millis(500);
const AGAIN_AFTER: Duration = Duration::from_millis(500);
/// Slow frames from one feedback of an action to the next.
const FEED_EVERY: u32 = SLOW_HZ / 10;
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
        object: graph.publishes(Role::Latched, &format!("/{name}/object"), Word::NAME)?,
        diagnostics: graph.publisher::<DiagnosticArray>("/diagnostics")?,
    };
    let desk = Desk::default();
    let heard = Arc::clone(&desk);
    let _subscription =
        graph.subscription::<GripperCommand>(&format!("/{name}/gripper_command"), move |command| {
            *heard.lock().unwrap_or_else(PoisonError::into_inner) = Some(command);
        })?;
    let mut actions = [Action::new(&mut graph, name, false)?, Action::new(&mut graph, name, true)?];
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
                    actions: &mut actions,
                    health: &mut health,
                    senses: None,
                    range_m: hand.range_m,
                    object: (Object::default(), ""),
                    grasp: None,
                    now: Gripper::default(),
                    fed: 0,
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
        for action in &mut actions {
            action.end(ABORTED, Gripper::default())?;
            action.serve(|_| false)?;
        }
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
    actions: &'a mut [Action<'b>; 2],
    health: &'a mut Health,
    senses: Option<Senses>,
    range_m: f64,
    /// The object, and the word that was published last.
    object: (Object, &'static str),
    grasp: Option<Grasp>,
    /// What an action says now, and slow frames since its last feedback.
    now: Gripper,
    fed: u32,
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
                self.command(&slow)?;
                self.publish(&slow)?;
            }
            Up::Senses(senses) => self.senses = Some(senses),
            Up::Counters(counters) => self.health.counters = Some(counters),
            Up::About(about) | Up::Answer { answer: Answer::About(about), .. } => {
                self.health.about = Some(about)
            }
            Up::Answer { of, answer: Answer::Refused(refusal), .. } => self.refused(of, refusal)?,
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
        let (object, said) = &mut self.object;
        let word = object.follow(slow);
        if word != *said {
            *said = word;
            self.topics.object.publish(&Word { data: word.to_owned() })?;
        }
        Ok(())
    }

    fn command(&mut self, slow: &Slow) -> anyhow::Result<()> {
        let ceiling = self.health.about.as_ref().and_then(ceiling_mn);
        let command = self.desk.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(command) = command {
            // The one that goes on is not what is wanted any more.
            self.over("another command came", ABORTED)?;
            match Grasp::of(&command, ceiling) {
                Ok(grasp) => self.begin(grasp),
                Err(why) => self.over(why, ABORTED)?,
            }
        }
        for n in 0..self.actions.len() {
            let mut begun = None;
            let cancelled = self.actions[n].serve(|command| match Grasp::of(command, ceiling) {
                Ok(grasp) => {
                    begun = Some(grasp);
                    true
                }
                Err(_) => false,
            })?;
            if cancelled || begun.is_some() {
                // The gentle grasp is the board's own.
                self.client.send(&Down::End)?;
                self.grasp = None;
                self.health.command = "cancelled".to_owned();
            }
            if let Some(grasp) = begun {
                self.actions[1 - n].end(ABORTED, self.now)?;
                self.begin(grasp);
            }
        }
        let Some(grasp) = &mut self.grasp else { return Ok(()) };
        let step = grasp.step(slow.forces.map(|forces| forces.load_mn));
        self.now = hand::gripper(slow, self.senses.as_ref(), self.range_m, grasp);
        match step {
            Step::Wait => {}
            Step::Done(why) => self.over(why, SUCCEEDED)?,
            Step::Over(why) => self.over(why, if self.now.reached_goal { SUCCEEDED } else { ABORTED })?,
            Step::Send(down) => self.send(down)?,
        }
        self.fed += 1;
        if self.fed >= FEED_EVERY {
            self.fed = 0;
            let now = self.now;
            self.actions.iter_mut().try_for_each(|action| action.feed(now))?;
        }
        Ok(())
    }

    fn begin(&mut self, grasp: Grasp) {
        (self.grasp, self.sessions, self.fed) = (Some(grasp), 0, 0);
        self.health.command = "goes on".to_owned();
    }

    fn send(&mut self, down: Down) -> anyhow::Result<()> {
        match self.client.send(&down) {
            Ok(number) => self.sent = Some((number, down)),
            Err(error) => self.over(&format!("{error:#}"), ABORTED)?,
        }
        Ok(())
    }

    /// The board has the last word. Without a session one is opened, and the step is sent once more.
    fn refused(&mut self, of: u16, refusal: Refusal) -> anyhow::Result<()> {
        let Some((_, down)) = self.sent.take_if(|(number, _)| *number == of) else { return Ok(()) };
        if matches!(refusal, Refusal::NoSession | Refusal::Replayed) && self.sessions < SESSIONS_MAX {
            self.sessions += 1;
            if let Ok(true) = self.client.open_session(ANSWER_WITHIN) {
                return self.send(down);
            }
        }
        self.over(&format!("refused by the board: {refusal:?}"), ABORTED)
    }

    fn over(&mut self, why: &str, status: i8) -> anyhow::Result<()> {
        self.grasp = None;
        self.health.command = why.to_owned();
        let now = self.now;
        self.actions.iter_mut().try_for_each(|action| action.end(status, now))
    }
}
