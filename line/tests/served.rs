//! A running board's line, served: settings are set and read back, no message is missed, and no client holds up the run.

use std::iter;
use std::thread;
use std::time::{Duration, Instant};

use tenax_frames::link::{Client, Counts, Target};
use tenax_frames::serve::{Options, Server, Tally};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Answer, Down, Refusal, Setting, Slow, Up};
use tenax_hal_shim::words::Line;
use tenax_logic::setting::SettingId;
use tenax_scene::plant::{Pins, Plant};
use tenax_sim::board::Run;
use tenax_sim::live::{Live, Person, Use};
use tenax_sim::session::Board;

use crate::serving::calm;

const WITHIN: Duration = Duration::from_secs(5);

/// A hand at rest, for how long, s, and whether it trusts its line.
struct Rest(Pins, f64, bool);

impl Plant for Rest {
    fn scan(&mut self, _drive: MotorDrive) -> &Pins {
        &self.0
    }

    fn duration_s(&self) -> f64 {
        self.1
    }

    fn trusts_line(&self) -> bool {
        self.2
    }
}

/// Serves a hand at rest on a pseudo-terminal and on TCP, while `visit` is told where.
fn serve(options: Options, rest: Rest, visit: impl FnOnce(&[Target]) + Send) -> (Run, Tally) {
    let _calm = calm();
    let options = Options { pty: true, tcp: Some(0), ..options };
    let (mut server, down) = Server::start(&options).expect("this machine has ptys and free ports");
    let places: Vec<Target> = server.places().iter().map(|place| place.parse().unwrap()).collect();
    thread::scope(|scope| {
        let visitor = scope.spawn(move || visit(&places));
        let mut run = Run::default();
        let live = Some(Live::new(down, Person::default()));
        let duration_s = rest.duration_s();
        let plant = Use { live, ..Use::default() }.of(rest);
        let began = Instant::now();
        run.summary = Board::Host.record(plant, &mut (&mut run, &mut server), &mut |_| {}).expect("a run").0;
        assert!(began.elapsed().as_secs_f64() > duration_s - 0.01, "never faster than real time");
        visitor.join().expect("the visitor found what it looked for");
        (run, server.close())
    })
}

/// Slow frames that come for this time, and at least one.
fn listen(client: &mut Client, time: Duration) -> Vec<Slow> {
    let (began, mut slows) = (Instant::now(), Vec::new());
    while began.elapsed() < time || slows.is_empty() {
        assert!(began.elapsed() < WITHIN, "nothing comes");
        if let Some(Up::Slow(slow)) = client.next_message().unwrap().map(|heard| heard.received.message) {
            slows.push(slow);
        }
    }
    slows
}

fn all_heard(client: &Client) {
    let Counts { missed, bad_frames, .. } = client.counts();
    assert_eq!((missed, bad_frames), (0, 0));
}

/// Sets S1, reads it back, and listens to more than ten slow frames, as long as a busy machine takes: everything comes, in order.
fn set_and_read_back(target: &Target, mv: i32) {
    let mut client = Client::open(target).unwrap();
    let setting = |value| Setting { id: SettingId::S1.number(), value };
    // Switched on with nothing held, the board consents within its first cycles: before that it refuses.
    let waits = iter::from_fn(|| listen(&mut client, Duration::ZERO).pop());
    waits.take(400).find(|slow| slow.line != Line::Reading).expect("it consents");
    let mut ask = |command| client.ask(&command, WITHIN).unwrap();
    assert_eq!(ask(Down::Set(setting(mv))), Answer::Setting(setting(mv)));
    assert_eq!(ask(Down::Get(setting(mv).id)), Answer::Setting(setting(mv)));
    let Answer::Settings(settings) = ask(Down::Settings(0)) else { panic!("the settings were asked for") };
    assert!(settings.contains(&setting(mv)));
    let refused = ask(Down::Set(setting(-1)));
    assert!(matches!(refused, Answer::Refused(Refusal::OutOfRange { .. })), "{refused:?}");
    let mut heard = 0;
    while heard <= 10 {
        heard += listen(&mut client, Duration::from_millis(500)).len();
    }
    all_heard(&client);
}

/// Consent ends 10 s after a board's start: one client has the time for it on any machine.
#[test]
fn a_setting_is_set_and_read_back_on_a_pty_on_its_symlink_and_on_tcp() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path().join("board");
    // Four commands each, and a session (refusal, number, opening): without trust, or where another client's numbers are ahead.
    for (trusts, clients, answers) in [(false, 1, 7..=7), (true, 3, 12..=18)] {
        let options = Options { at: Some(at.clone()), ..Options::default() };
        let (run, tally) = serve(options, Rest(Pins::default(), 12.0, trusts), |places| {
            assert_eq!(places.len(), 3);
            for (target, mv) in places.iter().zip([120, 130, 140]).take(clients) {
                set_and_read_back(target, mv);
                // A pty takes a client that comes within 10 ms of the one before for the same.
                thread::sleep(Duration::from_millis(100));
            }
        });
        assert!(answers.contains(&run.answers.len()), "{:?}", run.answers);
        assert_eq!(tally, Tally { clients: clients as u64, dropped: 0 });
        assert!(std::fs::symlink_metadata(&at).is_err(), "the symlink is gone");
    }
}

/// No writer of the client before is left to double what the next one hears. Thirty take 5 s, on a busy machine twice as long.
#[test]
fn clients_that_follow_each_other_at_once_hear_everything_once() {
    let (run, _) = serve(Options::default(), Rest(Pins::default(), 20.0, false), |places| {
        for wait_ms in (0..30).map(|n| 11 + n % 5) {
            let mut client = Client::open(&places[0]).unwrap();
            listen(&mut client, Duration::from_millis(150));
            assert_eq!(client.counts().missed, 0, "after {wait_ms} ms: {}", client.counts());
            drop(client);
            thread::sleep(Duration::from_millis(wait_ms));
        }
    });
    assert!(run.slows.len() > 500);
}

/// A client that never reads is on each place, and far more comes up than it has room for.
#[test]
fn a_client_that_never_reads_holds_up_nothing() {
    let options = Options { pty: true, tcp: Some(0), ..Options::default() };
    let (mut server, _down) = Server::start(&options).unwrap();
    let targets: Vec<Target> = server.places().iter().map(|place| place.parse().unwrap()).collect();
    let _clients: Vec<_> = targets.iter().map(|target| target.open().unwrap()).collect();
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
    assert!(tally.clients == 2 && tally.dropped > 10_000, "{tally}");
}

/// A witness on TCP tells how far the run was when the silent client of the pseudo-terminal left: a loaded machine runs behind the clock.
#[test]
fn clients_that_come_and_go_or_never_read_change_nothing_and_the_next_hears_nothing_old() {
    let (run, tally) = serve(Options::default(), Rest(Pins::default(), 3.0, false), |places| {
        let mut witness = Client::open(&places[1]).unwrap();
        let _silent = places[1].open().unwrap();
        let gone = places[0].open().unwrap();
        let seen = listen(&mut witness, Duration::from_millis(800)).pop().unwrap().frame;
        drop(gone);
        thread::sleep(Duration::from_millis(400));
        let mut client = Client::open(&places[0]).unwrap();
        let heard = listen(&mut client, Duration::from_millis(500));
        assert!(heard.iter().all(|slow| slow.frame > seen), "{seen}");
        all_heard(&client);
    });
    let (alone, _) = Board::Host.run(Rest(Pins::default(), 3.0, false), &mut |_| {}).unwrap();
    assert!(run.slows == alone.slows);
    assert_eq!((run.events.clone(), run.counters), (alone.events.clone(), alone.counters));
    assert_eq!(tally.clients, 4);
}

#[test]
fn a_place_that_cannot_be_had_is_named() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let error = |options: &Options| format!("{:#}", Server::start(options).err().unwrap());
    let at = Options { pty: true, at: Some(file.path().to_owned()), ..Options::default() };
    assert!(error(&at).contains("no symlink: choose another path"), "{}", error(&at));
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let said = error(&Options { tcp: Some(port), ..Options::default() });
    assert!(said.contains(&format!("cannot serve on TCP port {port}: choose another")), "{said}");
}
