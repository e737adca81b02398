//! Everything that goes wrong at once, for as long as one likes: wearers, faults of every kind, commands, lost frames,
//! settings at their ends, nonsense in flash.
//!
//! `TENAX_STEPS=10000000 cargo test --release -p tenax-host-tests --test fingertip adversary -- --nocapture`

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::channel::{
    CHANNELS, COUNT, FSR, FSR_COUNT, MYO_EXTENSOR, MYO_FLEXOR, MYO_SELECT, PVDF, PVDF_COUNT, mv_from_sample,
};
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::front_end::MYO_REST_MV;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::Down;
use tenax_hal_shim::words::{DriveSource, Kept};
use tenax_host_tests::{Bench, calibrated, set};
use tenax_logic::setting::SettingId;

/// The seed of every run.
const SEED: u32 = 0xAD;
/// Two slow frames.
const OPEN_WITHIN_FRAMES: u32 = 50;
/// The shortest hold of a muscle's activity that can be set, in frames.
const HOLD_FRAMES: u32 = 200;
/// Frames after which a pin that stands still, within 2 % and so much, is no muscle's until it leaves 6 %: 1 s. And after which that is
/// surely known.
const STILL_MV: i32 = 3;
const STILL_FRAMES: u32 = 2_000;
const LOST_FRAMES: u32 = 3_000;
/// The same of a pin below its range: 0.1 s.
const DEAD_FRAMES: u32 = 200;
/// Above this a muscle is active whatever the wearer: 160 mV, and what rounding takes.
const ACTIVE_MV: i32 = 162;
/// What a fault of a myosensor may open while something is held, mm of the scenes' hand, 120 mm/s at full duty: until a
/// contraction is proven, the hand opens by 0.7 mm, and again after 4 s of known rest (docs/emg.md).
const SAFE_MM: f64 = 0.75;
/// Frames without opening after which what was opened is another opening: 4 s.
const RENEWED_FRAMES: u32 = 8_000;
/// How long the muscles rest and are well before an opening is held to its time: 6 s.
const WELL_FRAMES: u32 = 12_000;
/// An opening that a muscle began goes on for a while when its electrode fails: what was proven counts for 1 s (docs/emg.md).
const ASKED_FRAMES: u32 = 2_200;
/// The largest blind budget that can be set, and a slow frame in which it is noticed, in frames.
const BLIND_FRAMES: u32 = 800 + 25;

/// What a myosensor's pin does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Pin {
    /// A muscle of so many mV above rest.
    Muscle(f64),
    /// A voltage, whatever the muscle does: broken, shorted, lifted, humming.
    Constant(f64),
    /// Creeps by so many mV a frame.
    Creep(f64),
}

/// Who does all this, and what a bystander knows of it.
struct Adversary {
    rng: ChaCha8Rng,
    bench: Bench,
    pins: [Pin; 2],
    started_at: u32,
    humming: Option<usize>,
    lost: Vec<u8>,
    no_wearer: bool,
    link_open_until: u32,
    /// Frame of the last reading of each muscle at which it was active.
    active_at: [Option<u32>; 2],
    /// Since when each pin is what it is.
    pins_since: [(Pin, u32); 2],
    /// Where each stands, mV above rest, and since when.
    stands: [(i32, u32); 2],
}

impl Adversary {
    fn new(seed: u64) -> Self {
        Self {
            rng: ChaCha8Rng::seed_from_u64(seed),
            bench: Bench::holding(seed),
            pins: [Pin::Muscle(50.0); 2],
            started_at: 0,
            humming: None,
            lost: Vec::new(),
            no_wearer: false,
            link_open_until: 0,
            active_at: [None; 2],
            pins_since: [(Pin::Muscle(50.0), 0); 2],
            stands: [(0, 0); 2],
        }
    }

    fn muscle(&mut self) -> Pin {
        let rng = &mut self.rng;
        match rng.random_range(0..9) {
            0..=3 => Pin::Muscle(rng.random_range(0.0..100.0)),
            4 | 5 => Pin::Muscle(rng.random_range(0.0..2_500.0)),
            6 => Pin::Constant(rng.random_range(0.0..3_300.0)),
            7 => Pin::Constant(rng.random_range(400.0..1_000.0)),
            _ => Pin::Creep(rng.random_range(0.05..15.0)),
        }
    }

    fn disturb(&mut self, step: u32) {
        match self.rng.random_range(0..14) {
            // A fault and a contraction of the other muscle in the same reading cannot be told from one contraction.
            0..=2 => {
                let n = self.rng.random_range(0..2);
                self.pins[n] = self.muscle();
            }
            3 | 4 => self.pins = [Pin::Muscle(50.0); 2],
            5 => self.bench.load(self.rng.random_range(0.0..60.0), self.rng.random_range(0.0..20.0)),
            6 => self.bench.load(self.rng.random_range(2.0..8.0), self.rng.random_range(0.0..4.0)),
            7 => {
                // One quadrant pressed by itself.
                let quadrant = FSR + self.rng.random_range(0..FSR_COUNT);
                self.bench.pins_mv[quadrant] += self.rng.random_range(-50.0..800.0);
            }
            8 => {
                self.bench.vibration_mv =
                    [0.0, 0.0, 35.0, self.rng.random_range(0.0..1_500.0)][self.rng.random_range(0..4)]
            }
            9 => self.humming = self.rng.random_bool(0.5).then(|| self.rng.random_range(0..PVDF_COUNT)),
            10 => {
                let pin = self.rng.random_range(0..COUNT);
                if !(MYO_FLEXOR..=MYO_EXTENSOR).contains(&pin) {
                    self.bench.pins_mv[pin] =
                        [0.0, 3_300.0, f64::from(CHANNELS[pin].rest_mv)][self.rng.random_range(0..3)];
                }
            }
            11 => {
                // The same places of every slow frame, for a while.
                let count = [0, 0, 1, 3, 8][self.rng.random_range(0..5)];
                self.lost = (0..count).map(|_| self.rng.random_range(0..25)).collect();
            }
            12 if self.rng.random_ratio(1, 40) => self.restart(step),
            _ => {
                for (n, channel) in CHANNELS.iter().enumerate() {
                    if !(MYO_FLEXOR..=MYO_EXTENSOR).contains(&n) {
                        self.bench.pins_mv[n] = f64::from(channel.rest_mv);
                    }
                }
                self.bench.load(4.0, 0.6);
            }
        }
    }

    /// Switched off and on, with nonsense in flash beside the wearer's calibration.
    fn restart(&mut self, step: u32) {
        let mut fingertip = calibrated();
        for kept in Kept::ALL {
            let length = self.rng.random_range(0..80) * 4;
            let nonsense: Vec<u8> = (0..length).map(|_| self.rng.random()).collect();
            if kept != Kept::Settings {
                fingertip.restore(kept, &nonsense);
            }
        }
        self.bench.fingertip = fingertip;
        self.no_wearer = false;
        self.link_open_until = 0;
        self.started_at = step;
    }

    fn command(&mut self, step: u32) {
        let rng = &mut self.rng;
        let duty = Duty::per_mille(rng.random_range(0..=1_000));
        let command = match rng.random_range(0..9) {
            0 => Down::Drive { drive: MotorDrive::Close(duty), hold_ms: rng.random_range(0..=300) },
            1 => Down::Drive { drive: MotorDrive::Open(duty), hold_ms: rng.random_range(0..=300) },
            2 => Down::Drive { drive: MotorDrive::Coast, hold_ms: 250 },
            3 => Down::Begin(Behaviour::Stroke),
            4 => Down::Zero,
            5 => Down::Save,
            _ => {
                let id = SettingId::ALL[rng.random_range(0..SettingId::ALL.len())];
                let row = id.row();
                set(
                    id,
                    [row.min, row.max, row.default, rng.random_range(row.min..=row.max)]
                        [rng.random_range(0..4)],
                )
            }
        };
        let accepted = self.bench.fingertip.command(&command).is_ok();
        self.no_wearer = self.bench.fingertip.config().no_wearer;
        // A bench whose line is not trusted any more would only hear refusals from then on.
        if command == set(SettingId::LineTrusted, 0) {
            self.restart(step);
        }
        if let (true, Down::Drive { drive, hold_ms }) = (accepted, command) {
            self.link_open_until = if drive.opens() { step + 2 * u32::from(hold_ms) } else { 0 };
        }
    }

    /// One frame: what the motor does.
    fn step(&mut self, step: u32) -> MotorDrive {
        // A fault on both at once is not told apart (docs/emg.md): the other one is a muscle's.
        let is_fault = |pin: Pin| !matches!(pin, Pin::Muscle(_));
        if self.pins.map(is_fault) == [true, true] {
            self.pins[0] = Pin::Muscle(50.0);
        }
        self.bench.lifted = self.pins.iter().position(|pin| is_fault(*pin)).map(|n| MYO_FLEXOR + n);
        for (pin, since) in self.pins.iter().zip(&mut self.pins_since) {
            if *pin != since.0 {
                *since = (*pin, step);
            }
        }
        for (n, pin) in self.pins.iter_mut().enumerate() {
            let mv = &mut self.bench.pins_mv[MYO_FLEXOR + n];
            match pin {
                Pin::Muscle(above) => *mv = f64::from(MYO_REST_MV) + *above,
                Pin::Constant(at) => *mv = *at,
                Pin::Creep(by) => *mv = (*mv + *by).min(3_300.0),
            }
        }
        if let Some(film) = self.humming {
            let phase = f64::from(step) * 50.0 / 2_000.0 * std::f64::consts::TAU;
            self.bench.pins_mv[PVDF + film] = f64::from(CHANNELS[PVDF].rest_mv) + 200.0 * phase.sin();
        }
        let whole = self.bench.frame();
        let gone = self.lost.contains(&whole.slot()) || self.rng.random_ratio(1, 500);
        let frame = if gone { Frame::lost(whole.sequence) } else { whole };
        if frame.valid && (MYO_SELECT..=MYO_SELECT + 1).contains(&frame.select()) {
            let channel = CHANNELS[MYO_FLEXOR];
            let mv = mv_from_sample(frame.switch_b);
            let muscle = usize::from(frame.select() - MYO_SELECT);
            let above = mv as i32 - MYO_REST_MV as i32;
            let counts = (channel.low_mv + 1..channel.high_mv).contains(&mv);
            let (stood_at, since) = &mut self.stands[muscle];
            let part = if step - *since >= STILL_FRAMES { 16 } else { 50 };
            if (above - *stood_at).abs() > stood_at.abs() / part + STILL_MV {
                (*stood_at, *since) = (above, step);
            }
            let stands_still = step - *since >= STILL_FRAMES;
            // With nobody to wait for, a sensor that is not believed silences nobody.
            if counts && above >= ACTIVE_MV && !stands_still && !self.no_wearer {
                self.active_at[muscle] = Some(step);
            }
        }
        self.bench.give(&frame)
    }

    /// Whether one electrode gives no number, or stands still far above rest.
    fn half_lost(&self, step: u32) -> bool {
        let is_lost = |(pin, since): &(Pin, u32)| match pin {
            Pin::Constant(at) if *at < f64::from(CHANNELS[MYO_FLEXOR].low_mv) => step - since >= DEAD_FRAMES,
            Pin::Constant(at) if *at > f64::from(MYO_REST_MV + 300) => step - since >= LOST_FRAMES,
            _ => false,
        };
        !self.no_wearer && self.pins_since.iter().any(is_lost)
    }

    fn is_active(&self, step: u32) -> bool {
        let recent = |at: &Option<u32>| at.is_some_and(|at| step - at < HOLD_FRAMES);
        !self.no_wearer && self.active_at.iter().any(recent)
    }
}

#[derive(Debug, Default)]
struct Seen {
    reflex: u64,
    opening: u64,
    /// Travel, mm, and at most, of openings that nobody at it or on the line had asked for: of a fault by itself, and beside
    /// another change of the muscles.
    stray_mm: f64,
    /// Whether another change of the muscles came before or with it.
    beside: bool,
    /// Whether the force sensor says that nothing is touched.
    empty: bool,
    strayed_at: u32,
    strays: u32,
    longest_stray_mm: [f64; 2],
    /// Of those, the ones that opened by more than is safe.
    long_strays: [u32; 2],
    /// Frames that the reflex closed while one electrode was lost.
    half: u32,
    /// Frames closed without a known force, or by the reflex with one electrode lost, since a muscle was active, and at most.
    blind: u32,
    most_blind: u32,
    active: [bool; 25],
    /// The last changes of the pins, for who has to find out.
    history: Vec<(u32, [Pin; 2])>,
    /// When the extensor's muscle was last above rest, if it is one.
    asked_at: Option<u32>,
}

impl Adversary {
    /// One frame, and what must hold in it.
    fn go(&mut self, step: u32, seen: &mut Seen) -> MotorDrive {
        let slot = self.bench.frames % 25;
        let drive = self.step(step);
        // Of this frame: what a slow frame says at its end came earlier, and a full opening of the frames between is half a millimetre.
        let tip = &self.bench.fingertip;
        let least_mn = tip.config().friction.loaded_mn / 4;
        seen.empty = tip.forces().is_some_and(|forces| forces.load_mn < least_mn);
        if matches!(self.pins[1], Pin::Muscle(mv) if mv > 100.0) {
            seen.asked_at = Some(step);
        }
        if seen.history.last().is_none_or(|last| last.1 != self.pins) {
            seen.history.push((step, self.pins));
            let old = seen.history.len().saturating_sub(6);
            seen.history.drain(..old);
        }
        seen.active[slot as usize] = self.is_active(step);
        let asked = seen.asked_at.is_some_and(|at| step - at < ASKED_FRAMES) || step < self.link_open_until;
        seen.opening += u64::from(drive.opens());
        // An empty finger drops nothing, and who is switched on anew does not know what was opened before.
        if asked || seen.empty || self.started_at == step || step - seen.strayed_at > RENEWED_FRAMES {
            seen.stray_mm = 0.0;
        } else if let MotorDrive::Open(duty) = drive {
            seen.strays += u32::from(seen.stray_mm == 0.0);
            seen.stray_mm += f64::from(duty.as_per_mille()) / 1_000.0 * 120.0 / 2_000.0;
        }
        if drive.opens() {
            seen.strayed_at = step;
        }
        // Where the flexor rises meanwhile, the two look like one contraction until the fault stands still.
        // And so does one fault that turns into another: the turn curves as a muscle does.
        let turns = |pins: [Pin; 2]| !matches!(pins[1], Pin::Muscle(_));
        let lately = seen.history.iter().rev().take_while(|(at, _)| step - at < 1_200);
        let two_faults = lately.clone().filter(|(_, pins)| turns(*pins)).map(|(_, pins)| pins[1]);
        let two_faults = two_faults.clone().any(|pin| two_faults.clone().any(|other| other != pin));
        let rises = lately.clone().any(|(_, pins)| !matches!(pins[0], Pin::Muscle(mv) if mv < 55.0));
        let lonely = !rises && !two_faults && matches!(self.pins[0], Pin::Muscle(mv) if mv < 55.0);
        // It is a fault by itself only if nothing else changed while it opened.
        seen.beside = !lonely || seen.stray_mm > 0.0 && seen.beside;
        let kind = usize::from(seen.beside);
        let before_mm = seen.stray_mm - if drive.opens() { 0.06 } else { 0.0 };
        seen.longest_stray_mm[kind] = seen.longest_stray_mm[kind].max(seen.stray_mm);
        if seen.stray_mm > SAFE_MM && before_mm <= SAFE_MM && drive.opens() {
            seen.long_strays[kind] += 1;
            let kind = ["by itself", "beside another change"][kind];
            println!("step {step}: {kind} opens {} mm, {:?}", seen.stray_mm, seen.history);
        }
        let Some(slow) = self.bench.slows.pop() else { return drive };
        self.bench.events.clear();
        let half_lost = self.half_lost(step);
        for (place, tick) in slow.ticks.iter().enumerate() {
            let reflex = tick.source == DriveSource::Reflex;
            seen.reflex += u64::from(reflex);
            assert!(
                !(reflex && seen.active[place]),
                "step {step}, place {place}: reflex while a muscle is active, {:?}",
                self.pins
            );
            assert!(!reflex || tick.drive.closes());
            let is_blind = match tick.source {
                DriveSource::Reflex => slow.forces.is_none() || half_lost,
                source => slow.forces.is_none() && source != DriveSource::Wearer,
            } && tick.drive.closes();
            seen.half += u32::from(half_lost && reflex);
            seen.blind += u32::from(is_blind);
        }
        if slow.wearer_active || step < self.started_at + 25 {
            seen.blind = 0;
        }
        seen.most_blind = seen.most_blind.max(seen.blind);
        assert!(seen.blind <= BLIND_FRAMES, "step {step}: {} frames closed blind", seen.blind);
        drive
    }
}

// Shows W2.
#[test]
fn whatever_goes_wrong_the_wearer_comes_first() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse().ok());
    let (steps, seed) = (number("TENAX_STEPS").unwrap_or(1_500_000), number("TENAX_SEED").unwrap_or(SEED));
    println!("seed {seed}, {steps} steps");
    let mut all = Adversary::new(seed.into());
    let mut seen = Seen::default();
    let (mut openings, mut slowest, mut step) = (0u32, 0u32, 0);
    while step < steps {
        // Now and then the wearer is well, rests, and opens; whatever else goes on.
        let opens_at = step + 60_000;
        while step < opens_at {
            if all.rng.random_ratio(1, 300) {
                all.disturb(step);
            }
            if all.rng.random_ratio(1, 1_000) {
                all.command(step);
            }
            all.go(step, &mut seen);
            step += 1;
        }
        (all.pins, all.lost) = ([Pin::Muscle(50.0); 2], Vec::new());
        for _ in 0..WELL_FRAMES {
            all.go(step, &mut seen);
            step += 1;
        }
        let level_mv = all.rng.random_range(900.0..2_400.0);
        all.pins[1] = Pin::Muscle(level_mv);
        let taken = (1..=OPEN_WITHIN_FRAMES).find(|n| all.go(step + n, &mut seen).opens());
        let Some(taken) = taken else {
            panic!(
                "seed {seed}, step {step}: a healthy opening of {level_mv} mV is not answered within 25 ms"
            )
        };
        step += OPEN_WITHIN_FRAMES + 1;
        (openings, slowest) = (openings + 1, slowest.max(taken));
    }
    let Seen { reflex, opening, half, strays, longest_stray_mm, long_strays, most_blind, .. } = seen;
    println!(
        "{reflex} reflex ticks, {half} with an electrode lost, {opening} opening ticks; {openings} healthy openings, the slowest in {slowest} frames; \
         {strays} times a fault opened, by {longest_stray_mm:?} mm at most (alone, beside another change), {long_strays:?} \
         of them by more than is safe; at most {most_blind} frames closed blind"
    );
    assert_eq!(long_strays[0], 0, "faults that open what is held");
    assert!(
        reflex > 500 && (half > 0 || seed != SEED) && opening > 500 && openings > 5,
        "what never happens proves nothing"
    );
}
