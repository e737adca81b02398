//! A board that is served at real time, and a step of bring-up that measures it.

use std::thread;
use std::time::{Duration, Instant};

use tenax_sim::live::{Live, Use};
use tenax_sim::session::Board;
use tenax_hal_shim::channel::COUNT;
use tenax_hal_shim::wire::Up;
use tenax_scene::plant::Plant;
use tenax_line::guide::bringup::{Asked, Figure, STEPS, Stream, Wire};
use tenax_frames::link::{Client, Target};
use tenax_frames::serve::{Options, Server};

/// What is asked for: a second, of all channels.
pub fn asked() -> Asked {
    Asked {
        lasts: Some(Duration::from_secs(1)),
        times: Some(1),
        channels: (0..COUNT).collect(),
        cut_power: None,
    }
}

/// Serves the plant's board while `visit` hears its line. The board goes on until the plant ends, or the test.
pub fn serve_wire<T>(board: Board, plant: impl Plant + 'static, visit: impl FnOnce(&mut Wire<'_>) -> T) -> T {
    let (mut server, down) = Server::start(&Options { tcp: Some(0), ..Options::default() }).unwrap();
    let place: Target = server.places()[0].parse().unwrap();
    let plant = Use { live: Some(Live::new(down, |_| {})), streams_at_start: false }.of(plant);
    let served = thread::spawn(move || board.record(plant, &mut server, &mut |_| {}).map(|_| ()));
    let open = || Client::open(&place);
    let mut wire = Wire::new(&open).unwrap();
    // It is up: an emulated one translates its image at first.
    let is_up = &mut |_: Instant, message: &Up| Ok(matches!(message, Up::Slow(_)));
    wire.wait(Duration::from_secs(300), "the board", Stream::default(), is_up).unwrap();
    let done = visit(&mut wire);
    assert!(!served.is_finished() || served.join().unwrap().is_ok());
    done
}

/// The same while steps of bring-up measure it.
pub fn serve<T>(
    board: Board,
    plant: impl Plant + 'static,
    visit: impl FnOnce(&mut dyn FnMut(&str, Asked) -> Vec<Figure>) -> T,
) -> T {
    serve_wire(board, plant, |wire| {
        visit(&mut |name, asked| {
            let step = STEPS.iter().find(|step| step.name == name).unwrap();
            let say = &mut |text: &str| {
                println!("{text}");
                Ok(())
            };
            step.measure(wire, &asked, say).unwrap()
        })
    })
}

/// The names of the figures that do not pass.
pub fn failing(figures: &[Figure]) -> Vec<&str> {
    figures.iter().filter(|figure| !figure.passes()).map(|figure| figure.name.as_str()).collect()
}
