//! What a bridge costs with so many hands: `cargo run --release --ignore-rust-version -p tenax-bridge --example load -- 100`.
//!
//! The first is a served scene, which takes commands. The others play what its line said, at its pace, for a served scene takes six times as
//! much of a core as its bridge; with `served` behind the number, all are scenes.

#[path = "../tests/common/mod.rs"]
mod common;

use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Command, Stdio};
use std::sync::mpsc::channel;
use std::thread;
use std::time::{Duration, Instant};

use common::Served;
use tenax_bridge::network::{Place, now_ns, open};
use tenax_hal_shim::wire::{Down, Up};
use tenax_hal_shim::words::DriveSource;
use tenax_ros2::cdr;
use tenax_ros2::key::{Attachment, topic};
use tenax_ros2::message::GripperCommand;
use tenax_serial::link::{Client, Line, Outbox, Target};
use zenoh::Wait;

const LISTENS_FOR: Duration = Duration::from_secs(10);
/// Longer than it takes to start, command and listen.
const PLAYS: Duration = Duration::from_secs(100);
const COMMANDS: usize = 30;
const SLOW_NS: i64 = 12_500_000;
const TICK_MS: f64 = 0.5;

fn percentile(values: &mut [f64], part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * part) as usize]
}

/// Time of a process on the cores so far, s: Linux counts hundredths.
fn core_s(process: u32) -> f64 {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap().split_whitespace().collect();
    (fields[11].parse::<f64>().unwrap() + fields[12].parse::<f64>().unwrap()) / 100.0
}

fn main() {
    let hands: usize = std::env::args().nth(1).map_or(1, |count| count.parse().expect("a number of hands"));
    let all_served = std::env::args().nth(2).is_some_and(|word| word == "served");
    let scene = include_str!("open.toml");
    let served: Vec<Served> = (0..if all_served { hands } else { 1 }).map(|_| Served::start(scene)).collect();
    let mut lines: Vec<String> = served.iter().map(|hand| hand.line.clone()).collect();
    lines.extend(played(&served[0].line, hands - served.len()));
    let at = format!("tcp/{}", TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap());
    let mut bridge =
        Command::new(std::env::current_exe().unwrap().ancestors().nth(2).unwrap().join("tenax-bridge"));
    bridge.args(["--router", &at, "--router-here", "--domain", "7"]).stderr(Stdio::null());
    for (n, line) in lines.iter().enumerate() {
        bridge.args(["--port", line, "--name", &format!("h{n}")]);
    }
    let mut bridge = bridge.spawn().expect("the bridge is built");
    let began = Instant::now();
    let session = loop {
        match open(&Place::At(at.clone())) {
            Ok(session) => break session,
            Err(error) => assert!(began.elapsed() < Duration::from_secs(20), "{error:#}"),
        }
    };
    commands(&session, &served[0].line);
    let (told, hears) = channel();
    let declared =
        session.declare_subscriber("7/*/*/tenax_msgs::msg::dds_::Slip_/*").callback(move |sample| {
            let attached = Attachment::of(&sample.attachment().unwrap().to_bytes()).unwrap();
            let _gone = told.send((attached, now_ns().cast_signed()));
        });
    declared.background().wait().unwrap();
    // The others too, for they are what costs.
    session.declare_subscriber("7/**").callback(|_| {}).background().wait().unwrap();
    thread::sleep(Duration::from_secs(1));
    let (core_before, began) = (core_s(bridge.id()), Instant::now());
    while hears.try_recv().is_ok() {}
    thread::sleep(LISTENS_FOR);
    let (mut delays, mut by_hand) = (Vec::new(), BTreeMap::<_, Vec<(i64, i64)>>::new());
    for (attached, came) in hears.try_iter() {
        delays.push((came - attached.time_ns) as f64 / 1e6);
        by_hand.entry(attached.gid).or_default().push((attached.sequence, came));
    }
    let part = (core_s(bridge.id()) - core_before) / began.elapsed().as_secs_f64();
    let (mut late, mut missing) = (Vec::new(), 0);
    for heard in by_hand.values() {
        let off: Vec<i64> = heard.iter().map(|(sequence, came)| came - sequence * SLOW_NS).collect();
        let least = off.iter().min().unwrap();
        late.extend(off.iter().map(|off| (off - least) as f64 / 1e6));
        missing += heard.last().unwrap().0 - heard[0].0 + 1 - heard.len() as i64;
    }
    println!(
        "{} of {hands} hands heard, {} messages of slip, {missing} missing",
        by_hand.len(),
        delays.len()
    );
    let (p50, p99) = (percentile(&mut delays, 0.5), percentile(&mut delays, 0.99));
    println!("published to heard: p50 {p50:.2} ms, p99 {p99:.2} ms");
    let (p50, p99) = (percentile(&mut late, 0.5), percentile(&mut late, 0.99));
    println!(
        "behind the earliest of its hand, its line's own pace included: p50 {p50:.2} ms, p99 {p99:.2} ms"
    );
    println!("bridge: {:.1} % of a core, {:.2} % a hand", part * 100.0, part * 100.0 / hands as f64);
    bridge.kill().unwrap();
    bridge.wait().unwrap();
}

/// Lines that play what this one says for [`PLAYS`], each from another instant on, to whoever connected last.
fn played(line: &str, count: usize) -> Vec<String> {
    if count == 0 {
        return Vec::new();
    }
    let heard = heard(line);
    let listeners: Vec<TcpListener> = (0..count).map(|_| TcpListener::bind("127.0.0.1:0").unwrap()).collect();
    let at = listeners.iter().map(|listener| format!("tcp:{}", listener.local_addr().unwrap())).collect();
    listeners.iter().for_each(|listener| listener.set_nonblocking(true).unwrap());
    thread::spawn(move || {
        let mut clients: Vec<Option<(TcpStream, Instant, usize)>> = (0..count).map(|_| None).collect();
        loop {
            for (n, (listener, client)) in listeners.iter().zip(&mut clients).enumerate() {
                if let Ok((stream, _)) = listener.accept() {
                    stream.set_nodelay(true).unwrap();
                    stream.set_nonblocking(true).unwrap();
                    // Hands are not in step.
                    *client =
                        Some((stream, Instant::now() + Duration::from_micros(n as u64 * 7_919 % 12_500), 0));
                }
                let Some((stream, began, next)) = client else { continue };
                let due = heard[*next..].iter().take_while(|(at, _)| *began + *at <= Instant::now());
                let bytes: Vec<u8> =
                    due.inspect(|_| *next += 1).flat_map(|(_, bytes)| bytes.clone()).collect();
                // Who connected only to look is gone.
                let _gone = stream.write_all(&bytes);
            }
            thread::sleep(Duration::from_millis(1));
        }
    });
    at
}

/// What a line says, piece by piece, and when.
fn heard(line: &str) -> Vec<(Duration, Vec<u8>)> {
    let Line { mut up, down } = line.parse::<Target>().unwrap().open().unwrap();
    let mut outbox = Outbox::new(down.unwrap());
    let mut pieces = Vec::new();
    let (began, mut buffer) = (Instant::now(), [0; 4096]);
    let mut asked_s = None;
    while began.elapsed() < PLAYS {
        // As the bridge asks.
        if asked_s.replace(began.elapsed().as_secs() / 2) != Some(began.elapsed().as_secs() / 2) {
            outbox.send(&Down::Stream { raw: false, senses: true, hold_s: 4 }).unwrap();
        }
        if let Ok(length) = up.read(&mut buffer) {
            pieces.push((began.elapsed(), buffer[..length].to_vec()));
        }
    }
    pieces
}

/// From a command's publication to the tick that drives the motor for it, as another client of the line hears.
fn commands(session: &zenoh::Session, line: &str) {
    let mut client = Client::open(&line.parse::<Target>().unwrap()).unwrap();
    // Until it consents, and what was said so far is heard.
    let until = Instant::now() + Duration::from_secs(3);
    while Instant::now() < until {
        client.next_message().unwrap();
    }
    let mut took = Vec::new();
    for n in 0..COMMANDS {
        // Commands come at any phase of a slow frame.
        thread::sleep(Duration::from_micros(7_300 * n as u64 % 12_500));
        let (position, max_effort) = if n % 2 == 0 { (0.0, 2.0) } else { (0.05, 0.0) };
        let payload = cdr::payload(&GripperCommand { position, max_effort }).unwrap();
        let sent = Instant::now();
        session.put(topic::<GripperCommand>(7, "/h0/gripper_command"), payload).wait().unwrap();
        let mut driven = None;
        // One of them takes a second and a half.
        while sent.elapsed() < Duration::from_millis(1_500) {
            let Some(heard) = client.next_message().unwrap() else { continue };
            if let Up::Slow(slow) = heard.received.message
                && driven.is_none()
                && let Some(tick) = slow.ticks.iter().position(|tick| tick.source == DriveSource::Link)
            {
                let ms_after = (slow.ticks.len() - 1 - tick) as f64 * TICK_MS;
                driven = Some(sent.elapsed().as_secs_f64() * 1e3 - ms_after);
            }
        }
        took.extend(driven);
    }
    assert!(!took.is_empty(), "no command drove the motor");
    let (count, most) = (took.len(), percentile(&mut took, 1.0));
    println!(
        "{count} of {COMMANDS} commands drove the motor: p50 {:.1} ms, at most {most:.1} ms",
        percentile(&mut took, 0.5)
    );
}
