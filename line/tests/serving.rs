//! A scene on the host's board whose line is served, and the tool as a person starts it.

use std::io;
use std::net::{Shutdown, TcpListener, TcpStream};
use std::process::{Command, Output};
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};
use std::thread::{self, JoinHandle};

use tenax_frames::serve::{Options, Server, Tally};
use tenax_scene::SceneFile;
use tenax_sim::live::{Live, Person, Use};
use tenax_sim::session::{Board, scene_served};

pub const BENCH: &str = include_str!("../../scenes/parts/bench.toml");

pub fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tenax"));
    command.args(args);
    command
}

/// Runs a command: whether it succeeded, its output and its messages.
pub fn tenax(args: &[&str]) -> (bool, String, String) {
    let Output { status, stdout, stderr } = command(args).output().unwrap();
    let [out, error] = [stdout, stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    (status.success(), out, error)
}

static LOAD: RwLock<()> = RwLock::new(());

/// Held by a test whose many clients keep the whole machine busy.
pub fn busy() -> RwLockWriteGuard<'static, ()> {
    LOAD.write().unwrap_or_else(PoisonError::into_inner)
}

/// Held by a test that a busy machine would fail: consent ends 10 s after a board's start.
pub fn calm() -> RwLockReadGuard<'static, ()> {
    LOAD.read().unwrap_or_else(PoisonError::into_inner)
}

/// A line to the place on a port that is free.
pub fn relay(place: &str, pass: impl FnMut(TcpStream, TcpStream) -> bool + Send + 'static) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let (own, place) = (listener.local_addr().unwrap(), place.to_owned());
    thread::spawn(move || relay_on(listener, &place, pass));
    format!("tcp:{own}")
}

/// `pass` passes what one connection after the other sends on to the place; then that connection is cut. False: it is the last one.
pub fn relay_on(listener: TcpListener, place: &str, mut pass: impl FnMut(TcpStream, TcpStream) -> bool) {
    for near in listener.incoming() {
        let far = TcpStream::connect(place.trim_start_matches("tcp:"));
        let (near, Ok(far)) = (near.unwrap(), far) else { return };
        let (mut up, mut out) = (far.try_clone().unwrap(), near.try_clone().unwrap());
        thread::spawn(move || {
            let _ended = io::copy(&mut up, &mut out);
            out.shutdown(Shutdown::Both)
        });
        let goes_on = pass(near.try_clone().unwrap(), far);
        let _gone = near.shutdown(Shutdown::Both);
        if !goes_on {
            return;
        }
    }
}

/// A number that whoever runs the tests asks for.
pub fn asked<N: FromStr>(name: &str) -> Option<N> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

/// The rig's scene on a board that trusts its line, so that nobody at the hand has to consent.
pub fn trusting() -> Serving {
    let rig = include_str!("../../scenes/rig.toml").replace("duration_s = 5.5", "duration_s = 60");
    Serving::start(&rig.replacen("\n[contact]", "\nline_trusted = true\n\n[contact]", 1))
}

pub struct Serving {
    pub place: String,
    person: Person,
    ended: Arc<AtomicBool>,
    run: JoinHandle<Tally>,
}

impl Serving {
    /// Serves a scene file's text. A board that is reset starts again and has kept its flash.
    pub fn start(scene: &str) -> Self {
        let file = SceneFile::parse(scene, "served").unwrap_or_else(|error| panic!("{error}"));
        let options = Options { tcp: Some(0), ..Options::default() };
        let (mut server, down) = Server::start(&options).unwrap();
        let place = server.places()[0].clone();
        let (person, ended) = (Person::default(), Arc::<AtomicBool>::default());
        let (runs, ends) = (person.clone(), Arc::clone(&ended));
        let run = thread::spawn(move || {
            loop {
                let live = Live::new(down.clone(), runs.clone());
                let line = Use { live: Some(live), without_bound: true, ..Use::default() };
                scene_served(&file, 1, &Board::Host, line, &mut server, &mut |_| {}).unwrap();
                if !runs.lets_go() || ends.load(Relaxed) {
                    return server.close();
                }
            }
        });
        Self { place, person, ended, run }
    }

    /// What a person at the bench does.
    pub fn tell(&self, line: &str) {
        match line {
            "button" => self.person.press(),
            "reset" => self.person.reset(),
            _ => line.parse().into_iter().for_each(|act| self.person.act(act)),
        }
    }

    pub fn end(self) -> Tally {
        self.ended.store(true, Relaxed);
        self.person.reset();
        self.run.join().unwrap()
    }
}
