//! One recording: a world, its operator, and what the board's slow frame reads of the array.

use rand::{SeedableRng, rngs::ChaCha8Rng};
use tenax_hal_shim::channel::{ARRAY_COUNT, SCAN_HZ, SCANS_PER_FRAME};
use tenax_hal_shim::frame::{Frame, Scan, scan_of_pins};
use tenax_hal_shim::motor::MotorDrive;
use tenax_scene::World;
use tenax_scene::plant::Plant;

use super::operator::Operator;
use super::session::Session;
use super::story::Story;
use tenax_sim::report::fate;
use tenax_sim::scorer::SlipSpan;

const SCAN_S: f64 = 1.0 / SCAN_HZ as f64;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Instant of the last element's reading, s.
    pub t_s: f64,
    /// 14 bits each, as the slow frame reads them: one after the other, each the sum of four codes.
    pub samples: [u16; ARRAY_COUNT],
    /// Whether the box moved over the pads since the step before, faster than the scene's floor.
    pub slips: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    pub story: Story,
    pub steps: Vec<Step>,
    /// Slips that the world counted, and micro slip that came to nothing.
    pub spans: Vec<SlipSpan>,
    /// Whether it fell; then the recording ends there.
    pub dropped: bool,
}

/// A stream of the session's seed: 0 for the story, 1 for the operator, 3 for the world.
fn stream(session: &Session, story: Story, number: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(session.seed);
    rng.set_stream(1 + 4 * story as u64 + number);
    rng
}

/// Records a story of a session. Fails if the session has a number that no scene may have.
pub fn record(session: &Session, story: Story) -> anyhow::Result<Recording> {
    let scene = story.scene_in(session, &mut stream(session, story, 0), |_| ())?;
    let mut operator = Operator::new(story, session, stream(session, story, 1));
    let mut world = World::new(&scene, rand::RngExt::random(&mut stream(session, story, 3)));
    let floor_mm = scene.slip_floor_mm_s();
    let mut drive = MotorDrive::Coast;
    let (mut steps, mut samples) = (Vec::new(), [0; ARRAY_COUNT]);
    let (mut rubbed_mm, mut since_s) = (0.0, 0.0);
    for sequence in 0.. {
        if world.now_s() >= scene.duration_s() || world.truth().dropped {
            break;
        }
        let select = Frame::lost(sequence).select();
        let mut scans = [Scan::default(); SCANS_PER_FRAME];
        let mut slips = false;
        for scan in &mut scans {
            *scan = scan_of_pins(&world.scan(drive).codes(), select);
            slips = world.slipping();
            if slips {
                rubbed_mm += world.touch().rub_m_s() * 1e3 * SCAN_S;
            }
        }
        let frame = Frame::from_scans(sequence, &scans);
        let place = usize::from(frame.slot());
        if let Some(sample) = samples.get_mut(place) {
            *sample = frame.switch_b;
        }
        if place == ARRAY_COUNT - 1 {
            let t_s = world.now_s();
            steps.push(Step { t_s, samples, slips: rubbed_mm > floor_mm * (t_s - since_s) });
            (rubbed_mm, since_s) = (0.0, t_s);
        }
        drive = operator.drive(&world, slips);
    }
    let truth = world.truth();
    Ok(Recording { story, steps, spans: fate::spans(truth), dropped: truth.dropped })
}
