//! Watches a line or a recording on a thread of its own. A line is opened again whenever it ends.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread;
use std::time::Duration;

use tenax_frames::link::{ANSWER_WITHIN, Board, Client, Counts, Heard, Target};
use tenax_frames::play::{self, Reel};
use tenax_hal_shim::wire::{Answer, BadFrame, Down};

const AGAIN_AFTER: Duration = Duration::from_millis(500);

#[derive(Debug)]
pub enum News {
    Open,
    Gone(String),
    /// The board is plugged in elsewhere.
    Moved(String),
    /// A message, or why a frame is none; the counts so far.
    Frame(Result<Heard, BadFrame>, Counts),
    Played(play::Told),
    Answered(Down, Result<Answer, String>),
}

/// Starts the thread, which ends when `news` is dropped. Lines sent to what it returns control how a recording is played.
pub fn start(line: &Target, commands: Receiver<Down>, news: Sender<News>) -> Sender<String> {
    let (player, controls) = channel();
    let target = line.clone();
    thread::spawn(move || {
        let Target::File(path) = &target else { return watch(&target, &commands, &news) };
        if let Err(error) = watch_recording(path, &controls, &news) {
            let _left = news.send(News::Gone(format!("{error:#}")));
        }
    });
    player
}

fn watch_recording(path: &Path, controls: &Receiver<String>, news: &Sender<News>) -> anyhow::Result<()> {
    let reel = Reel::open(path)?;
    play::play(reel, controls, &mut |told| news.send(News::Played(told)).is_ok());
    Ok(())
}

fn watch(target: &Target, commands: &Receiver<Down>, news: &Sender<News>) {
    let mut board = Board::at(target.clone());
    loop {
        let ended = match board.open() {
            Ok((client, moved)) => {
                moved.into_iter().for_each(|words| _ = news.send(News::Moved(words)));
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

/// Attends to one line until it ends; the reason. None: `news` was dropped.
fn attend(mut client: Client, commands: &Receiver<Down>, news: &Sender<News>) -> Option<String> {
    news.send(News::Open).ok()?;
    // A reading command: whether the last run ended in a fault.
    let _asked = client.send(&Down::Last(0));
    loop {
        let _asked = client.keep_streaming(false);
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
            Ok(Some(frame)) => news.send(News::Frame(frame, client.counts())).ok()?,
            Ok(None) => {}
            Err(error) => return Some(error.to_string()),
        }
    }
}
