//! Watches a line, a recording and a scene's true state on threads of their own. A line is opened again whenever it ends.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread;
use std::time::{Duration, Instant};

use tenax_frames::link::{ANSWER_WITHIN, Client, Counts, Heard, Target};
use tenax_frames::play::{self, Playing, Reel};
use tenax_frames::truth::{self, Bench, Truth};
use tenax_hal_shim::wire::{Answer, BadFrame, Down};

const AGAIN_AFTER: Duration = Duration::from_millis(500);
/// Readings are asked for at this interval, for twice as long.
const STREAM_EVERY: Duration = Duration::from_secs(2);

#[derive(Debug)]
pub enum News {
    Open,
    /// The line is gone, with the reason.
    Gone(String),
    /// A message, or why a frame is none; the counts so far; the time of arrival.
    Frame(Result<Heard, BadFrame>, Counts, Instant),
    Truth(Truth),
    /// What can be done at the scene's bench; None: the scene is gone.
    Bench(Option<Bench>),
    Playing(Playing),
    /// The recording goes on elsewhere.
    Rewound,
    Answered(Down, Result<Answer, String>),
}

#[derive(Clone, Debug)]
pub struct Places {
    pub line: Target,
    /// Address of the scene's true state.
    pub truth: Option<Target>,
}

/// Starts the threads, which end when `news` is dropped. Lines sent to what it returns are done at the scene's bench, or control how a
/// recording is played.
pub fn start(places: &Places, commands: Receiver<Down>, news: Sender<News>) -> Sender<String> {
    let (bench, acts) = channel();
    if let Target::File(path) = places.line.clone() {
        thread::spawn(move || {
            if let Err(error) = watch_recording(&path, &acts, &news) {
                let _left = news.send(News::Gone(format!("{error:#}")));
            }
        });
        return bench;
    }
    if let Some(target) = places.truth.clone() {
        let news = news.clone();
        let mut tell = move |told| {
            let told = match told {
                truth::Told::Truth(truth) => News::Truth(truth),
                truth::Told::Bench(bench) => News::Bench(bench),
            };
            news.send(told).is_ok()
        };
        thread::spawn(move || truth::watch(&target, &acts, &mut tell));
    }
    let target = places.line.clone();
    thread::spawn(move || watch(&target, &commands, &news));
    bench
}

fn watch_recording(path: &Path, controls: &Receiver<String>, news: &Sender<News>) -> anyhow::Result<()> {
    let reel = Reel::open(path)?;
    let mut counts = Counts::default();
    let playing = Playing::new(&reel);
    let _left = news.send(News::Playing(playing));
    play::play(&reel, playing, controls, &mut |told| {
        let told = match told {
            play::Told::Message(heard) => {
                counts.messages += 1;
                counts.missed += u64::from(heard.missed);
                News::Frame(Ok(*heard), counts, Instant::now())
            }
            play::Told::Again => News::Rewound,
            play::Told::At(playing) => News::Playing(playing),
            play::Told::Over => return true,
        };
        news.send(told).is_ok()
    });
    Ok(())
}

fn watch(target: &Target, commands: &Receiver<Down>, news: &Sender<News>) {
    loop {
        let ended = match Client::open(target) {
            Ok(client) => match attend(client, commands, news) {
                Some(why) => why,
                None => return,
            },
            Err(error) => format!("{error:#}"),
        };
        if news.send(News::Gone(ended)).is_err() {
            return;
        }
        thread::sleep(AGAIN_AFTER);
    }
}

/// Attends to one line until it ends; the reason. None: `news` was dropped.
fn attend(mut client: Client, commands: &Receiver<Down>, news: &Sender<News>) -> Option<String> {
    news.send(News::Open).ok()?;
    let mut streamed: Option<Instant> = None;
    // Reading commands: identity, and whether the last run ended in a fault.
    let _asked = client.send(&Down::About);
    let _asked = client.send(&Down::Last(0));
    loop {
        if streamed.is_none_or(|at| at.elapsed() >= STREAM_EVERY) {
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
