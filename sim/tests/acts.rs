//! Whoever sits at the bench that serves: the glass is gripped, pulled, wetted and put down by keys.

use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::GripMode;
use tenax_scene::World;
use tenax_scene::plant::{Pins, Plant};
use tenax_sim::board::Run;
use tenax_sim::session::{Board, load_scene};

/// The bench on which these keys are typed at these instants, s.
struct Typed {
    world: World,
    keys: Vec<(f64, &'static str)>,
    for_s: f64,
}

impl Plant for Typed {
    fn within(&self) -> Option<&dyn Plant> {
        Some(&self.world)
    }

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        let now_s = self.world.now_s();
        let due = self.keys.iter().take_while(|(at_s, _)| *at_s <= now_s).count();
        self.keys.drain(..due).for_each(|(_, key)| self.world.act(key.parse().unwrap()));
        self.world.scan(drive)
    }

    fn duration_s(&self) -> f64 {
        self.for_s
    }
}

fn typed(keys: &[(f64, &'static str)], for_s: f64, seed: u64) -> (Run, World) {
    let world = World::new(&load_scene("bench").unwrap(), seed);
    let (run, bench) = Board::Host.run(Typed { world, keys: keys.to_vec(), for_s }, &mut |_| {}).unwrap();
    (run, bench.world)
}

/// Instants at which the hand answers slip, s.
fn slips(run: &Run) -> Vec<f64> {
    let is_slip =
        |kind: &EventKind| matches!(kind, EventKind::Mode { to: GripMode::Slip | GripMode::Incipient, .. });
    run.events.iter().filter(|event| is_slip(&event.kind)).map(|event| f64::from(event.frame) / 2e3).collect()
}

#[test]
fn keys_grip_lift_pull_wet_and_put_down() {
    for seed in 1..=3 {
        let keys = [(2.0, "g"), (7.0, "w"), (12.0, "w"), (14.0, "p"), (17.0, "d")];
        let (run, world) = typed(&keys, 23.0, seed);
        let truth = world.truth();
        let height_mm = |at_s: f64| truth.trace.iter().find(|row| row.t_s >= at_s).unwrap().position_mm;
        assert!(height_mm(1.9).abs() < 5.0 && height_mm(6.5) > 80.0, "gripped and lifted");
        assert!(slips(&run).iter().any(|at_s| (7.2..8.0).contains(at_s)), "wetted: {:?}", slips(&run));
        assert!(!truth.dropped && height_mm(22.9) < 5.0, "held until it is put down");
        let grips = |at_s: f64| truth.trace.iter().find(|row| row.t_s >= at_s).unwrap().grip_n > 0.5;
        assert!(grips(16.9) && !grips(22.9), "let go");
        // The controls: nobody types, or nobody wets.
        let (run, world) = typed(&[], 8.0, seed);
        assert!(slips(&run).is_empty() && world.truth().trace.iter().all(|row| row.grip_n == 0.0));
        let (run, _) = typed(&keys[..1], 12.0, seed);
        assert!(slips(&run).iter().all(|at_s| !(7.2..8.0).contains(at_s)), "{:?}", slips(&run));
    }
}
