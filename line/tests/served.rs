//! A running board's line, served: settings are set and read back, no message is missed, and no client holds up the run.

use std::fs;
use std::thread;
use std::time::{Duration, Instant};

use tenax_frames::link::{Client, Target};
use tenax_frames::serve::{Options, Server, Tally};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Answer, Down, Refusal, Setting, Up};
use tenax_hal_shim::words::Line;
use tenax_logic::setting::SettingId;
use tenax_scene::plant::{Pins, Plant};
use tenax_sim::board::Run;
use tenax_sim::live::{Live, Use};
use tenax_sim::session::Board;

const WITHIN: Duration = Duration::from_secs(5);

struct Rest(Pins, f64);

impl Plant for Rest {
    fn scan(&mut self, _drive: MotorDrive) -> &Pins {
        &self.0
    }

    fn duration_s(&self) -> f64 {
        self.1
    }
}

fn start(options: &Options) -> (Server, Live) {
    let (server, down) = Server::start(options).expect("this machine has ptys and free ports");
    (server, Live::new(down, |_| {}))
}

/// Serves a hand at rest for this time, s, while `visit` is told where.
fn serve(options: &Options, duration_s: f64, visit: impl FnOnce(&[Target]) + Send) -> (Run, Tally) {
    let (mut server, live) = start(options);
    let places: Vec<Target> = server.places().iter().map(|place| place.parse().unwrap()).collect();
    thread::scope(|scope| {
        let visitor = scope.spawn(move || visit(&places));
        let mut run = Run::default();
        let plant = Use { live: Some(live), streams_at_start: false }.of(Rest(Pins::default(), duration_s));
        let began = Instant::now();
        run.summary = Board::Host.record(plant, &mut (&mut run, &mut server), &mut |_| {}).expect("a run").0;
        assert!(began.elapsed().as_secs_f64() > duration_s - 0.01, "never faster than real time");
        visitor.join().expect("the visitor found what it looked for");
        (run, server.close())
    })
}

fn setting(id: SettingId, value: i32) -> Setting {
    Setting { id: id.number(), value }
}

/// Sets S1, reads it back, and listens for half a second: everything comes, in order.
fn set_and_read_back(target: &Target, mv: i32) {
    let mut client = Client::open(target).unwrap();
    let s1 = setting(SettingId::S1, mv);
    // Switched on with nothing held, the board consents within its first cycles: whoever is there before is refused.
    let began = Instant::now();
    let is_armed = |up: &Up| matches!(up, Up::Slow(slow) if slow.line != Line::Reading);
    while !client.next_message().unwrap().is_some_and(|heard| is_armed(&heard.received.message)) {
        assert!(began.elapsed() < WITHIN, "it never consents");
    }
    assert_eq!(client.ask(&Down::Set(s1), WITHIN).unwrap(), Answer::Setting(s1));
    assert_eq!(client.ask(&Down::Get(s1.id), WITHIN).unwrap(), Answer::Setting(s1));
    let Answer::Settings(settings) = client.ask(&Down::Settings(0), WITHIN).unwrap() else {
        panic!("the settings were asked for");
    };
    assert!(settings.contains(&s1));
    let refused = client.ask(&Down::Set(setting(SettingId::S1, -1)), WITHIN).unwrap();
    assert!(matches!(refused, Answer::Refused(Refusal::OutOfRange { .. })), "{refused:?}");
    let began = Instant::now();
    let mut slows = 0;
    while began.elapsed() < Duration::from_millis(500) {
        let heard = client.next_message().unwrap();
        slows += usize::from(heard.is_some_and(|heard| matches!(heard.received.message, Up::Slow(_))));
    }
    assert!(slows > 10, "{slows}");
    assert_eq!((client.counts().missed, client.counts().bad_frames), (0, 0), "{}", client.counts());
}

#[test]
fn a_setting_is_set_and_read_back_on_a_pty_on_its_symlink_and_on_tcp() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path().join("board");
    let options = Options { pty: true, at: Some(at.clone()), tcp: Some(0), ..Options::default() };
    let (run, tally) = serve(&options, 6.0, |places| {
        assert_eq!(places.len(), 3);
        for (target, mv) in places.iter().zip([120, 130, 140]) {
            set_and_read_back(target, mv);
            // Whoever opens a pty within 10 ms of the one before is taken for the same.
            thread::sleep(Duration::from_millis(100));
        }
    });
    // Four commands each, and the session that the first asked for: a refusal, its number, its opening.
    assert_eq!(run.answers.len(), 3 * 7);
    assert_eq!(tally, Tally { clients: 3, dropped: 0 });
    assert!(fs::symlink_metadata(&at).is_err(), "the symlink is gone");
}

/// Somebody who runs one command after the other: no writer of the client before is left to double what the next one hears.
#[test]
fn clients_that_follow_each_other_at_once_hear_everything_once() {
    let (run, _) = serve(&Options { pty: true, ..Options::default() }, 8.0, |places| {
        for wait_ms in (0..30).map(|n| 11 + n % 5) {
            let mut client = Client::open(&places[0]).unwrap();
            let began = Instant::now();
            while began.elapsed() < Duration::from_millis(150) {
                client.next_message().unwrap();
            }
            assert_eq!(client.counts().missed, 0, "after {wait_ms} ms: {}", client.counts());
            drop(client);
            thread::sleep(Duration::from_millis(wait_ms));
        }
    });
    assert!(run.slows.len() > 500);
}

/// With a client that never reads on each, far more comes up than any of them has room for.
#[test]
fn a_client_that_never_reads_holds_up_nothing() {
    let (mut server, _live) = start(&Options { pty: true, tcp: Some(0), ..Options::default() });
    let targets: Vec<Target> = server.places().iter().map(|place| place.parse().unwrap()).collect();
    let clients: Vec<_> = targets.iter().map(|target| target.open().unwrap()).collect();
    let joined = Instant::now();
    let frame: Vec<u8> = (0..200).map(|n| u8::from(n < 199)).collect();
    let (mut sent, mut longest) = (0, Duration::ZERO);
    // Until both have come and are full; a pty notices a client after 10 ms.
    while sent < 100_000 || joined.elapsed() < Duration::from_millis(500) {
        let began = Instant::now();
        server.line(&frame);
        longest = longest.max(began.elapsed());
        sent += 1;
    }
    assert!(longest < Duration::from_millis(500), "{longest:?}");
    let began = Instant::now();
    let tally = server.close();
    assert!(began.elapsed() < Duration::from_secs(2), "{:?}", began.elapsed());
    assert_eq!(tally.clients, 2);
    assert!(tally.dropped > 10_000, "{tally}");
    drop(clients);
}

#[test]
fn who_comes_and_goes_and_who_never_reads_changes_nothing_in_the_run() {
    let options = Options { pty: true, tcp: Some(0), ..Options::default() };
    let (run, tally) = serve(&options, 2.0, |places| {
        let _silent: Vec<_> = places.iter().map(|place| place.open().unwrap()).collect();
        for _ in 0..5 {
            let gone = places[1].open().unwrap();
            thread::sleep(Duration::from_millis(50));
            drop(gone);
        }
        thread::sleep(Duration::from_millis(500));
    });
    let (alone, _) = Board::Host.run(Rest(Pins::default(), 2.0), &mut |_| {}).unwrap();
    assert!(run.slows == alone.slows);
    assert_eq!((run.events.clone(), run.counters), (alone.events.clone(), alone.counters));
    assert_eq!(tally.clients, 7);
}

/// What a client has not read is not the next one's. A witness on TCP tells how far the run was when the first one left: a
/// loaded machine runs behind the clock.
#[test]
fn the_second_client_of_a_pty_hears_nothing_old() {
    let options = Options { pty: true, tcp: Some(0), ..Options::default() };
    serve(&options, 3.0, |places| {
        let mut witness = Client::open(&places[1]).unwrap();
        let silent = places[0].open().unwrap();
        let began = Instant::now();
        let mut seen = 0;
        while began.elapsed() < Duration::from_millis(800) || seen == 0 {
            assert!(began.elapsed() < WITHIN, "nothing comes");
            if let Some(Up::Slow(slow)) = witness.next_message().unwrap().map(|heard| heard.received.message)
            {
                seen = slow.frame;
            }
        }
        drop(silent);
        thread::sleep(Duration::from_millis(400));
        let mut client = Client::open(&places[0]).unwrap();
        let frames: Vec<u32> = std::iter::from_fn(|| Some(client.next_message().unwrap()))
            .take(60)
            .flatten()
            .filter_map(|heard| match heard.received.message {
                Up::Slow(slow) => Some(slow.frame),
                _ => None,
            })
            .collect();
        assert!(!frames.is_empty() && frames.iter().all(|&frame| frame > seen), "{seen} {frames:?}");
        assert_eq!((client.counts().missed, client.counts().bad_frames), (0, 0), "{}", client.counts());
    });
}

#[test]
fn a_place_that_cannot_be_had_is_named() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let error = |options: &Options| format!("{:#}", Server::start(options).err().unwrap());
    let at = Options { pty: true, at: Some(file.path().to_owned()), ..Options::default() };
    assert!(error(&at).contains("no symlink: choose another path"), "{}", error(&at));
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let tcp = Options { tcp: Some(port), ..Options::default() };
    assert!(
        error(&tcp).contains(&format!("cannot serve on TCP port {port}: choose another")),
        "{}",
        error(&tcp)
    );
}
