use super::*;
use crate::config::Config;
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::motor::Duty;
use tenax_hal_shim::words::Fault;

struct Bench {
    motor: Motor,
    config: MotorConfig,
    journal: Journal,
    cycle: u32,
    state: u32,
    opening_mv: f64,
    current_pin_mv: Option<f64>,
    opening_pin_mv: Option<f64>,
    told: std::vec::Vec<(u32, EventKind)>,
}

const CYCLES_PER_S: u32 = SLOW_HZ;

impl Bench {
    fn new(seed: u32) -> Self {
        Self {
            motor: Motor::default(),
            config: Config::default().motor,
            journal: Journal::default(),
            cycle: 0,
            state: seed,
            opening_mv: 1_500.0,
            current_pin_mv: None,
            opening_pin_mv: None,
            told: std::vec::Vec::new(),
        }
    }

    fn random(&mut self, below: u32) -> u32 {
        self.state = self.state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.state >> 8) % below
    }

    fn sample(&mut self, mv: f64) -> u16 {
        let noise = self.random(5) as u16;
        (sample_from_mv(mv.clamp(0.0, 3_300.0) as u32) + noise).saturating_sub(2)
    }

    fn cycle(&mut self, asked: MotorDrive, turns: f64) -> MotorDrive {
        self.motor_is_asked(asked, 0, turns)
    }

    fn motor_is_asked(&mut self, asked: MotorDrive, rests: u32, turns: f64) -> MotorDrive {
        let drive = if self.motor.allows(asked) { asked } else { MotorDrive::Coast };
        for look in 0..STEPS {
            let drives = look < STEPS - rests;
            let coasts = MotorDrive::Coast;
            self.motor.step(if drives { asked } else { coasts }, if drives { drive } else { coasts });
        }
        let (way, duty) = match drive {
            MotorDrive::Coast => (0.0, 0.0),
            MotorDrive::Close(duty) => (-1.0, f64::from(duty.as_per_mille()) / 1e3),
            MotorDrive::Open(duty) => (1.0, f64::from(duty.as_per_mille()) / 1e3),
        };
        // 120 mm/s are 36 mV in a slow frame; who turns for ever turns to and fro.
        self.opening_mv =
            1_000.0 + (self.opening_mv - 1_000.0 + way * duty * turns * 36.0).rem_euclid(1_500.0);
        let shown_mv = 300.0 + 2_400.0 * duty * (1.0 - turns);
        for (channel, pin_mv, mv) in
            [(OPENING, self.opening_pin_mv, self.opening_mv), (MOTOR_CURRENT, self.current_pin_mv, shown_mv)]
        {
            let sample = self.sample(mv);
            let sample = pin_mv.map_or(sample, |mv| sample_from_mv(mv as u32));
            self.motor.take(channel, Some(sample));
        }
        self.cycle += 1;
        self.journal.begin(&Frame::lost(self.cycle));
        self.motor.judge(&self.config, &mut self.journal);
        while let Some(event) = self.journal.next_event() {
            self.told.push((event.frame, event.kind));
        }
        drive
    }

    fn driven(&mut self, asked: MotorDrive, turns: f64, cycles: u32) -> u32 {
        (0..cycles).map(|_| u32::from(self.cycle(asked, turns) != MotorDrive::Coast)).sum()
    }

    fn stops(&self) -> std::vec::Vec<Option<MotorStop>> {
        let stop = |kind: &EventKind| if let EventKind::Motor(stop) = *kind { Some(stop) } else { None };
        self.told.iter().filter_map(|(_, kind)| stop(kind)).collect()
    }

    fn is_lost(&self, channel: usize) -> bool {
        let is = |kind: &EventKind| matches!(*kind, EventKind::Fault(Fault::SensorLost { channel: own, .. }) if usize::from(own) == channel);
        self.told.iter().any(|(_, kind)| is(kind))
    }
}

fn close(permille: u16) -> MotorDrive {
    MotorDrive::Close(Duty::per_mille(permille))
}

fn open(permille: u16) -> MotorDrive {
    MotorDrive::Open(Duty::per_mille(permille))
}

// Shows B9.
#[test]
fn a_blocked_motor_stops_within_half_a_second_at_any_duty_and_says_so() {
    for permille in [100, 300, 400, 700, 1_000] {
        for (drive, stop) in
            [(close(permille), MotorStop::ClosingStalled), (open(permille), MotorStop::OpeningStalled)]
        {
            let mut bench = Bench::new(1);
            bench.driven(MotorDrive::Coast, 0.0, 200);
            assert!(bench.driven(drive, 1.0, 400) == 400, "the control: it turns");
            let driven = bench.driven(drive, 0.0, 400);
            assert!((20..=CYCLES_PER_S / 2 - 8).contains(&driven), "{drive:?}: {driven} slow frames");
            assert_eq!(bench.stops(), [Some(stop)], "and once, as long as it is asked for");
        }
    }
}

// Shows B10.
#[test]
fn one_lost_sensor_is_reported_and_the_other_one_stops_a_stall() {
    for (current_mv, opening_mv, channel) in
        [(Some(0.0), None, MOTOR_CURRENT), (Some(3_300.0), None, MOTOR_CURRENT), (None, Some(0.0), OPENING)]
    {
        let mut bench = Bench::new(2);
        (bench.current_pin_mv, bench.opening_pin_mv) = (current_mv, opening_mv);
        bench.driven(MotorDrive::Coast, 0.0, 80);
        assert!(bench.is_lost(channel));
        assert_eq!(bench.driven(close(800), 0.9, 400), 400, "it closes as ever while it turns");
        let driven = bench.driven(close(800), 0.0, 400);
        assert!((20..=CYCLES_PER_S / 2 - 8).contains(&driven), "{channel}: {driven}");
        bench.driven(MotorDrive::Coast, 0.0, 20);
        assert!(bench.driven(open(300), 1.0, 100) == 100);
    }
}

// Shows B10.
#[test]
fn without_either_sensor_the_duty_is_taken_for_a_stall_and_only_closing_waits_until_it_has_cooled() {
    let mut bench = Bench::new(3);
    (bench.current_pin_mv, bench.opening_pin_mv) = (Some(0.0), Some(0.0));
    bench.driven(MotorDrive::Coast, 0.0, 80);
    assert!(bench.is_lost(MOTOR_CURRENT) && bench.is_lost(OPENING));
    let driven = bench.driven(close(1_000), 0.0, 300);
    assert!((CYCLES_PER_S..2 * CYCLES_PER_S).contains(&driven), "{driven}");
    assert_eq!(bench.stops()[0], Some(MotorStop::Hot));
    assert_eq!(bench.driven(open(1_000), 0.0, 800), 800, "nothing says that an opening stalls");
    bench.driven(MotorDrive::Coast, 0.0, 20 * CYCLES_PER_S);
    assert!(bench.driven(close(1_000), 0.0, 80) == 80, "it has cooled");
}

// Shows B10.
#[test]
fn a_current_that_nobody_drives_is_the_sensors_fault_and_stops_nothing_for_ever() {
    let mut bench = Bench::new(4);
    bench.driven(MotorDrive::Coast, 0.0, 80);
    let mut driven = 0;
    for n in 0..60 * CYCLES_PER_S {
        let mv = 2_700.0 + f64::from(n % 3);
        bench.current_pin_mv = Some(mv);
        driven += u32::from(
            bench.cycle(if n % 160 < 80 { close(600) } else { MotorDrive::Coast }, 0.9) != MotorDrive::Coast,
        );
    }
    assert!(bench.is_lost(MOTOR_CURRENT));
    assert!(driven > 29 * CYCLES_PER_S, "{driven}: it was hot for a second at most");
    bench.current_pin_mv = None;
    bench.driven(MotorDrive::Coast, 0.0, 80);
    let back = EventKind::Fault(Fault::SensorBack { channel: MOTOR_CURRENT as u8 });
    assert!(bench.told.iter().any(|(_, kind)| *kind == back));
}

// Shows W2, B9.
#[test]
fn an_opening_wins_over_a_stalled_closing_at_once_and_over_its_own_stall_when_it_is_asked_for_again() {
    let mut bench = Bench::new(5);
    bench.driven(close(1_000), 0.0, 100);
    assert!(!bench.motor.allows(close(1_000)) && bench.motor.allows(open(1)));
    assert_eq!(bench.driven(open(300), 1.0, 100), 100);
    assert!(bench.motor.allows(close(1_000)), "another way has been driven");
    bench.driven(open(300), 0.0, 100);
    assert!(!bench.motor.allows(open(300)));
    assert!(bench.motor.allows(open(500)), "a stronger contraction tries");
    bench.driven(MotorDrive::Coast, 0.0, CYCLES_PER_S / 5);
    assert!(bench.motor.allows(open(300)), "so does the next one");
}

// Shows B9.
#[test]
fn a_motor_that_turns_under_too_much_current_is_hot_and_says_so() {
    let mut bench = Bench::new(7);
    // 0.7 A for ever, where 0.5 are allowed. It turns.
    let driven = bench.driven(close(1_000), 0.3, 60 * CYCLES_PER_S);
    assert!((2 * CYCLES_PER_S..40 * CYCLES_PER_S).contains(&driven), "{driven}");
    assert_eq!(bench.stops()[0], Some(MotorStop::Hot));
    let mut bench = Bench::new(7);
    assert_eq!(bench.driven(close(1_000), 0.76, 600 * CYCLES_PER_S), 600 * CYCLES_PER_S);
    assert_eq!(bench.stops(), []);
}

// Shows W2, B9.
#[test]
fn whatever_happened_an_opening_may_be_driven_after_a_rest_and_a_closing_once_it_is_cool() {
    let mut bench = Bench::new(9);
    for round in 0..2_000 {
        let duty = 1 + bench.random(1_000) as u16;
        let asked = [MotorDrive::Coast, close(duty), open(duty)][bench.random(3) as usize];
        let (turns, rests) = (f64::from(bench.random(11)) / 10.0, bench.random(STEPS));
        for pin in [0, 1] {
            let broken = match bench.random(60) {
                0 => Some(0.0),
                1 => Some(3_300.0),
                2 => Some(f64::from(bench.random(3_300))),
                3..30 => continue,
                _ => None,
            };
            if pin == 0 { bench.current_pin_mv = broken } else { bench.opening_pin_mv = broken }
        }
        let cycles = bench.random(100);
        (0..cycles).for_each(|_| _ = bench.motor_is_asked(asked, rests, turns));
        if asked.closes() && rests < STEPS && cycles > 0 {
            assert!(bench.motor.allows(open(1)), "round {round}");
        }
        if round % 10 == 9 {
            bench.driven(MotorDrive::Coast, 0.0, CYCLES_PER_S / 5);
            assert!(bench.motor.allows(open(1)), "round {round}");
        }
        if round % 100 == 99 {
            bench.driven(MotorDrive::Coast, 0.0, 30 * CYCLES_PER_S);
            assert!(bench.motor.allows(close(1)), "round {round}");
        }
    }
}
