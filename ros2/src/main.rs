//! `cargo tenax bridge`.
#![forbid(unsafe_code)]

use std::collections::BTreeSet;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use anyhow::{Context, bail, ensure};
use clap::Parser;
use signal_hook::consts::{SIGINT, SIGTERM};
use tenax_frames::link::board::chip_of;
use tenax_frames::link::{Board, Target};
use tenax_ros2::bridge::hand::{Hand, bridge};
use tenax_ros2::bridge::network::{Place, open};
use tenax_ros2::key::{Domain, is_name};
use zenoh::Wait;

const EXAMPLES: &str = "\
ROS 2 Jazzy or newer, or Humble with --humble, with rmw_zenoh (RMW_IMPLEMENTATION=rmw_zenoh_cpp), whose nodes meet at a router: start it with \
`ros2 run rmw_zenoh_cpp rmw_zenohd`, or let the bridge be the router (--router-here).

Publishes, 80 times a second: /NAME/joint_states (position: gap; effort: grip force, N), /NAME/slip, /NAME/margin, \
/NAME/tactile; at each change, and for who comes later, /NAME/object (none, held, slipping or lost); each second /diagnostics. Takes the actions \
/NAME/gripper_cmd (control_msgs/action/GripperCommand) and /NAME/parallel_gripper_cmd (ParallelGripperCommand), and \
control_msgs/msg/GripperCommand on the topic /NAME/gripper_command: position 0 closes to \
max_effort, N (0: until the object is felt), above 0 opens. The board obeys only with consent at the hand, and below its \
force ceiling.

Examples:
  cargo tenax bridge                                            the board that is plugged in, as /hand
  cargo tenax bridge --port tcp:127.0.0.1:7777 --router-here    a served scene, and no ROS 2 router
  cargo tenax bridge --port /dev/ttyACM0 --name left --port /dev/ttyACM1 --name right
  cargo tenax bridge --port /dev/ttyACM0 --name left=003900423231510400000001    that board, wherever it is plugged in
  ros2 topic echo /hand/joint_states
  ros2 action send_goal --feedback /hand/gripper_cmd control_msgs/action/GripperCommand \
'{command: {position: 0.0, max_effort: 5.0}}'";

/// Bring fingertips into ROS 2 over zenoh, without a ROS install.
#[derive(Debug, Parser)]
#[command(name = "tenax bridge", version, after_help = EXAMPLES)]
struct Args {
    /// A hand's serial line: /dev/ttyACM0, /dev/pts/5 or tcp:127.0.0.1:7777; may be given more than once [default: the only
    /// board that is plugged in]
    #[arg(long, value_name = "PORT")]
    port: Vec<Target>,
    /// Name of each port's hand in ROS 2, in order, and the chip that it holds to, as the bridge says it at its start
    /// [default: hand, or hand_1, hand_2 and so on; the chip that is there at the start]
    #[arg(long, value_name = "NAME[=CHIP]")]
    name: Vec<String>,
    /// Gap of the open hand, m [default: positions are parts of it, 0 to 1]
    #[arg(long, value_name = "M", default_value_t = 1.0, hide_default_value = true)]
    range_m: f64,
    /// Address of ROS 2's zenoh router
    #[arg(long, value_name = "tcp/HOST:PORT", default_value = "tcp/127.0.0.1:7447")]
    router: String,
    /// Be the router at --router: no rmw_zenohd needed
    #[arg(long)]
    router_here: bool,
    /// ROS 2's domain, 0 to 232 [default: ROS_DOMAIN_ID, or 0]
    #[arg(long, value_parser = clap::value_parser!(u32).range(0..=232))]
    domain: Option<u32>,
    /// Speak to nodes of ROS 2 Humble, which hear nothing without it
    #[arg(long)]
    humble: bool,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

/// The hands that are meant. Fails if two are called the same, or one as ROS allows no name.
fn hands(args: &Args) -> anyhow::Result<Vec<Hand>> {
    let lines =
        if args.port.is_empty() { vec![tenax_line::cli::port::or_found(None)?] } else { args.port.clone() };
    ensure!(
        args.name.is_empty() || args.name.len() == lines.len(),
        "{} hands and {} names: give each hand one, or none",
        lines.len(),
        args.name.len()
    );
    let several = lines.len() > 1;
    let own = |n: usize| if several { format!("hand_{}", n + 1) } else { "hand".to_owned() };
    let mut taken = BTreeSet::new();
    let mut hands = Vec::new();
    for (n, line) in lines.into_iter().enumerate() {
        let given = args.name.get(n).cloned().unwrap_or_else(|| own(n));
        let (name, chip) = match given.split_once('=') {
            None => (given, None),
            Some((name, chip)) => {
                let number =
                    chip_of(chip).with_context(|| format!("{chip} is no chip: 24 hexadecimal digits"))?;
                (name.to_owned(), Some(number))
            }
        };
        ensure!(is_name(&name), "`{name}` is no name for ROS 2: letters, digits and _, a letter first");
        ensure!(taken.insert(name.clone()), "two hands are called {name}");
        hands.push(Hand { name, board: Board { chip, ..Board::at(line) }, range_m: args.range_m });
    }
    Ok(hands)
}

fn run(args: &Args) -> anyhow::Result<()> {
    let mut hands = hands(args)?;
    // A line that cannot be opened is said now; one that goes away later is waited for.
    for hand in &mut hands {
        let (_, moved) = hand.board.open()?;
        moved.into_iter().for_each(|words| eprintln!("/{}: {words}", hand.name));
    }
    let set = || std::env::var("ROS_DOMAIN_ID").ok()?.parse().ok();
    let domain = Domain { number: args.domain.or_else(set).unwrap_or(0), humble: args.humble };
    let place = if args.router_here { Place::RouterHere } else { Place::At };
    let session = open(&place(args.router.clone()))?;
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        signal_hook::flag::register(signal, Arc::clone(&stop)).context("cannot listen to Ctrl-C")?;
    }
    for Hand { name, board, .. } in &hands {
        eprintln!("/{name}: {}, chip {}", board.line, board.chip_words());
    }
    eprintln!("in ROS 2's domain {} at {}; Ctrl-C ends it", domain.number, args.router);
    let run = &|(id, hand): (u32, &Hand)| {
        let ended = bridge(&session, domain, id, hand, &stop);
        // The session is all hands': none goes on without it.
        stop.store(true, Ordering::Relaxed);
        ended
    };
    let ended: anyhow::Result<()> = thread::scope(|scope| {
        let threads: Vec<_> = (0..).zip(&hands).map(|one| scope.spawn(move || run(one))).collect();
        let mut threads = threads.into_iter();
        threads.try_for_each(|thread| thread.join().unwrap_or_else(|_| bail!("a hand's thread panicked")))
    });
    let _closed = session.close().wait();
    ended
}
