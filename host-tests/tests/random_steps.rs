//! The contract with the wearer over a million random steps, watched by somebody who uses none of the logic's code. The seed is
//! printed.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_hal_shim::behaviour::{Behaviour, CameraView};
use tenax_hal_shim::channel::{CHANNELS, COUNT, MYO_FLEXOR, MYO_SELECT, mv_from_sample};
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::front_end::MYO_REST_MV;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{DRIVE_HOLD_MAX_MS, Down, EventKind};
use tenax_hal_shim::words::{Cause, Code, DriveSource};
use tenax_host_tests::teaching::SLIP_MV;
use tenax_host_tests::{Bench, set};
use tenax_logic::config::Config;
use tenax_logic::setting::SettingId;

const STEPS: u32 = 1_000_000;

/// What a bystander knows of one muscle from the same samples, without any of the logic's code.
#[derive(Default)]
struct Bystander {
    last_mv: Option<i32>,
    active_at: Option<u32>,
}

impl Bystander {
    fn see(&mut self, frame: u32, sample: u16) {
        let channel = CHANNELS[MYO_FLEXOR];
        let mv = mv_from_sample(sample);
        self.last_mv =
            (channel.low_mv + 1..channel.high_mv).contains(&mv).then(|| mv as i32 - MYO_REST_MV as i32);
        if self.last_mv >= Some(i32::from(Config::default().gate.on_mv)) {
            self.active_at = Some(frame);
        }
    }

    fn is_active(&self, frame: u32) -> bool {
        self.active_at.is_some_and(|at| frame - at < Config::default().gate.hold_frames)
    }
}

fn disturb(bench: &mut Bench, rng: &mut ChaCha8Rng) {
    match rng.random_range(0..13) {
        12 => bench.sliding_mv = [0.0, 0.0, 0.0, rng.random_range(20.0..120.0)][rng.random_range(0..4)],
        0 => bench.load(rng.random_range(0.0..60.0), rng.random_range(0.0..20.0)),
        1 => bench.vibration_mv = [0.0, 0.0, SLIP_MV, rng.random_range(0.0..1_500.0)][rng.random_range(0..4)],
        2 | 3 => bench.muscles(rng.random_range(0.0..100.0), rng.random_range(0.0..100.0)),
        4 => bench.muscles(rng.random_range(0.0..2_500.0), rng.random_range(0.0..100.0)),
        5 => bench.muscles(rng.random_range(0.0..100.0), rng.random_range(0.0..2_500.0)),
        6 => bench.muscles(rng.random_range(0.0..2_500.0), rng.random_range(0.0..2_500.0)),
        7 => bench.pins_mv[rng.random_range(0..COUNT)] = [0.0, 3_300.0][rng.random_range(0..2)],
        8 | 9 => {
            let n = rng.random_range(0..COUNT);
            bench.pins_mv[n] = f64::from(CHANNELS[n].rest_mv);
        }
        _ => bench.load(rng.random_range(3.0..8.0), rng.random_range(0.0..4.0)),
    }
}

fn random_command(rng: &mut ChaCha8Rng) -> Down {
    let duty = Duty::per_mille(rng.random_range(0..=1_000));
    let drive = [MotorDrive::Coast, MotorDrive::Close(duty), MotorDrive::Open(duty)][rng.random_range(0..3)];
    match rng.random_range(0..9) {
        8 => Down::View(CameraView {
            age_ms: rng.random_range(0..250),
            moving_e4: rng.random_range(0..40),
            angle_ddeg: rng.random::<bool>().then_some(rng.random_range(-900..900)),
            normal: std::array::from_fn(|_| rng.random()),
            shear: std::array::from_fn(|_| rng.random()),
        }),
        6 => Down::Save,
        7 => Down::Network,
        0 => Down::Drive { drive, hold_ms: rng.random_range(0..=400) },
        1 => set(SettingId::S1, rng.random::<u16>().into()),
        2 => set(SettingId::S2, rng.random::<u16>().into()),
        3 => match rng.random_range(0..6) {
            0 => Down::Begin(Behaviour::Stroke),
            1 => Down::Begin(Behaviour::GentleGrasp),
            2 => Down::Begin(Behaviour::Hold),
            3 => Down::Begin(Behaviour::HandOver),
            4 => Down::Begin(Behaviour::Turn { by_ddeg: rng.random_range(-300..300) }),
            _ => Down::End,
        },
        4 => set(SettingId::HebbianSlip, rng.random_range(0..1_000)),
        _ => Down::Zero,
    }
}

// Shows W1.
#[test]
fn a_million_random_steps() {
    const SEED: u64 = 0x7E4A;
    println!("seed {SEED:#x}");
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let mut bench = Bench::taught(SEED);
    let (mut flexor, mut extensor) = (Bystander::default(), Bystander::default());
    let mut link_open_until = 0;
    // A teacher who talks nonsense, a few seconds of each: the network learns whatever there is.
    let mut says = [Code::Minus, Code::Plus];
    let (mut by_network, mut by_array) = (0u32, 0u32);
    let (mut reflexes, mut behaved, mut opens, mut acted_on) = (0u32, 0u32, 0u32, 0u32);
    let mut active = [false; 25];
    for step in 0..STEPS {
        if rng.random_ratio(1, 300) {
            disturb(&mut bench, &mut rng);
        }
        if rng.random_ratio(1, 2_000) {
            let command = random_command(&mut rng);
            let accepted = bench.fingertip.command(&command).is_ok();
            if let Down::Drive { drive, hold_ms } = command {
                assert!(!accepted || hold_ms <= DRIVE_HOLD_MAX_MS);
                if accepted {
                    link_open_until = if drive.opens() { step + u32::from(hold_ms) * 2 } else { 0 };
                }
            }
        }
        if rng.random_ratio(1, 6_000) {
            says = [0, 1].map(|_| [Code::Minus, Code::Zero, Code::Plus][rng.random_range(0..3)]);
        }
        if step % 66 == 0 {
            let age_ms = rng.random_range(30..60);
            bench.fingertip.command(&Down::Teach { codes: says, age_ms }).unwrap();
        }
        let whole = bench.frame();
        let frame = if rng.random_ratio(1, 500) { Frame::lost(whole.sequence) } else { whole };
        if frame.valid && frame.select() == MYO_SELECT {
            flexor.see(step, frame.switch_b);
        }
        if frame.valid && frame.select() == MYO_SELECT + 1 {
            extensor.see(step, frame.switch_b);
        }
        let lets_go =
            matches!(bench.fingertip.behaviour(), Some(Behaviour::HandOver | Behaviour::Turn { .. }));
        let drive = bench.give(&frame);
        active[usize::from(frame.slot())] = flexor.is_active(step) || extensor.is_active(step);
        if drive.opens() {
            opens += 1;
            let muscle = extensor.last_mv >= Some(100);
            let asked = step < link_open_until || lets_go;
            assert!(muscle || asked, "step {step}: opened, and nobody asked");
        }
        let Some(slow) = bench.slows.pop() else { continue };
        for event in bench.events.drain(..) {
            match event.kind {
                EventKind::Mode { cause: Cause::Slip(DetectorId::Hebbian), .. } => by_network += 1,
                EventKind::Mode { cause: Cause::Slip(DetectorId::Mlp), .. } => by_array += 1,
                _ => {}
            }
        }
        for (place, tick) in slow.ticks.iter().enumerate() {
            let reflex = tick.source == DriveSource::Reflex;
            let behaves = tick.source == DriveSource::Behaviour;
            behaved += u32::from(behaves);
            assert!(!(behaves && active[place]), "step {step}, place {place}: a behaviour while a muscle is");
            reflexes += u32::from(reflex);
            acted_on += u32::from(active[place] && !tick.acted.is_empty());
            assert!(
                !(reflex && active[place]),
                "step {step}, place {place}: reflex while a muscle is active"
            );
            assert!(!reflex || tick.drive.closes());
        }
    }
    println!(
        "{reflexes} reflex ticks, {behaved} of behaviours, {opens} opening ticks, {by_network} pulses of the network's, {by_array} of the array's"
    );
    assert!(by_network > 5 && by_array > 5, "a detector that never speaks proves nothing");
    assert!(
        reflexes > 5_000 && behaved > 300 && opens > 5_000,
        "the silence is worth nothing unless both happen at other times"
    );
    assert_eq!(acted_on, 0, "while the wearer is active no detector is acted on");
}
