//! The board's line on a thread of its own: it is opened again whenever it ends, commands go down it, and all that comes
//! up is handed on.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread;
use std::time::{Duration, Instant};

use tenax_hal_shim::wire::{Answer, BadFrame, Down};

use tenax_frames::link::{ANSWER_WITHIN, Client, Counts, Heard, Target};
use tenax_frames::play::{self, Playing, Reel, Told as Played};
use tenax_frames::truth::{self, Bench, Told, Truth};

/// Pause before a line is opened again.
const AGAIN_AFTER: Duration = Duration::from_millis(500);
/// Readings are asked for this often, for twice as long.
const STREAM_EVERY: Duration = Duration::from_secs(2);

/// What there is to tell.
#[derive(Debug)]
pub enum News {
    Open,
    /// It is not, and why.
    Gone(String),
    /// A message, or a frame that is none; what has been counted; and when it came.
    Frame(Result<Heard, BadFrame>, Counts, Instant),
    /// What really happens in the scene.
    Truth(Truth),
    /// What can be done at the scene's bench; None: there is none any more.
    Bench(Option<Bench>),
    /// Where the recording is that is watched.
    Playing(Playing),
    /// It goes on elsewhere.
    Rewound,
    /// What was asked, and the answer.
    Answered(Down, Result<Answer, String>),
}

#[derive(Clone, Debug)]
pub struct Places {
    pub line: Target,
    /// Where what really happens is told, if that is known.
    pub truth: Option<Target>,
}

/// Watches all of it on threads of their own, which end when nobody listens any more. Lines that are sent to what it returns are
/// done at the bench of a scene that tells the truth, or say how a recording is played; anywhere else they go nowhere.
pub fn start(places: &Places, commands: Receiver<Down>, news: Sender<News>) -> Sender<String> {
    let (bench, acts) = channel();
    if let Target::File(path) = places.line.clone() {
        thread::spawn(move || {
            if let Err(error) = watch_recording(&path, &acts, &news) {
                // Nobody listens any more.
                let _left = news.send(News::Gone(format!("{error:#}")));
            }
        });
        return bench;
    }
    if let Some(target) = places.truth.clone() {
        let news = news.clone();
        let mut tell = move |told| {
            let told = match told {
                Told::Truth(truth) => News::Truth(truth),
                Told::Bench(bench) => News::Bench(bench),
            };
            news.send(told).is_ok()
        };
        thread::spawn(move || truth::watch(&target, &acts, &mut tell));
    }
    let target = places.line.clone();
    thread::spawn(move || watch(&target, &commands, &news));
    bench
}

/// Plays a recording until nobody listens any more.
fn watch_recording(path: &Path, controls: &Receiver<String>, news: &Sender<News>) -> anyhow::Result<()> {
    let mut reel = Reel::open(path)?;
    let mut counts = Counts::default();
    let playing = Playing::new(&reel);
    let _left = news.send(News::Playing(playing));
    play::play(&mut reel, playing, controls, &mut |told| {
        let told = match told {
            Played::Message(heard) => {
                counts.messages += 1;
                counts.missed += u64::from(heard.missed);
                News::Frame(Ok(*heard), counts, Instant::now())
            }
            Played::Again => News::Rewound,
            Played::At(playing) => News::Playing(playing),
            Played::Over => return true,
        };
        news.send(told).is_ok()
    })
}

/// Watches a line until nobody listens any more.
pub fn watch(target: &Target, commands: &Receiver<Down>, news: &Sender<News>) {
    loop {
        let ended = match Client::open(target) {
            Ok(client) => {
                if news.send(News::Open).is_err() {
                    return;
                }
                match attend(client, commands, news) {
                    Some(why) => why,
                    None => return,
                }
            }
            Err(error) => format!("{error:#}"),
        };
        if news.send(News::Gone(ended)).is_err() {
            return;
        }
        thread::sleep(AGAIN_AFTER);
    }
}

/// One line until it ends: why it did. None when nobody listens any more.
fn attend(mut client: Client, commands: &Receiver<Down>, news: &Sender<News>) -> Option<String> {
    let mut streamed: Option<Instant> = None;
    if client.can_send() {
        // They only read, and an older image answers what it knows.
        let _asked = client.send(&Down::About);
        // Whether its last run ended in a fault.
        let _asked = client.send(&Down::Last(0));
    }
    loop {
        if client.can_send() && streamed.is_none_or(|at| at.elapsed() >= STREAM_EVERY) {
            let hold_s = 2 * STREAM_EVERY.as_secs() as u16;
            let _asked = client.send(&Down::Stream { raw: false, senses: true, hold_s });
            streamed = Some(Instant::now());
        }
        loop {
            match commands.try_recv() {
                Ok(command) => {
                    let answer = client.ask(&command, ANSWER_WITHIN).map_err(|error| format!("{error:#}"));
                    news.send(News::Answered(command, answer)).ok()?;
                }
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => return None,
            }
        }
        match client.next_frame() {
            Ok(Some(frame)) => news.send(News::Frame(frame, client.counts(), Instant::now())).ok()?,
            Ok(None) => {}
            Err(error) => return Some(error.to_string()),
        }
    }
}
