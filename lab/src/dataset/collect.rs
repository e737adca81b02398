//! One recording: a world, its operator, and what the board's slow frame reads of the array.

use rand::{SeedableRng, rngs::ChaCha8Rng};
use tenax_hal_shim::channel::{ARRAY_COUNT, SCAN_HZ, SCANS_PER_FRAME};
use tenax_hal_shim::frame::{Frame, Scan, scan_of_pins};
use tenax_hal_shim::motor::MotorDrive;
use tenax_scene::plant::Plant;
use tenax_scene::{SceneFile, World};

use super::marker::Marker;
use super::operator::Operator;
use super::session::Session;
use super::story::Story;
use tenax_sim::report::fate;
use tenax_sim::scorer::SlipSpan;

const SCAN_S: f64 = 1.0 / SCAN_HZ as f64;

/// One time step of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// When the last element was read, s.
    pub t_s: f64,
    /// The ten samples, 14 bits each, as the slow frame reads them: one after the other, each the sum of four codes.
    pub samples: [u16; ARRAY_COUNT],
    /// Whether the box slipped since the step before: it moved over the pads, by sliding or turning, faster than the
    /// scene's floor.
    pub slips: bool,
    /// Whether the marker says so.
    pub marker_slips: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// What is recorded.
    pub story: Story,
    /// Its steps, 80 a second.
    pub steps: Vec<Step>,
    /// Slips that the world counted, and micro slip that came to nothing.
    pub spans: Vec<SlipSpan>,
    /// How far the box slid in all of them, mm.
    pub slid_mm: f64,
    /// Whether it fell; then the recording ends there.
    pub dropped: bool,
}

impl Recording {
    /// Slips that the world counted.
    pub fn slips(&self) -> usize {
        self.spans.iter().filter(|span| span.macro_onset_s.is_some()).count()
    }
}

/// What draws for a recording, each a stream of the session's seed.
#[derive(Clone, Copy, Debug)]
enum Stream {
    Story,
    Operator,
    Marker,
    World,
}

fn stream(session: &Session, story: Story, stream: Stream) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(session.seed);
    rng.set_stream(1 + 4 * story as u64 + stream as u64);
    rng
}

/// Records a story of a session. Fails if the session has a number that no scene may have.
pub fn record(session: &Session, story: Story) -> anyhow::Result<Recording> {
    let scene = story.scene_in(session, &mut stream(session, story, Stream::Story))?;
    let operator = Operator::new(story, session, stream(session, story, Stream::Operator));
    let marker = Marker::new(stream(session, story, Stream::Marker));
    let seed = rand::RngExt::random(&mut stream(session, story, Stream::World));
    Ok(Camera { scene: &scene, operator, marker }.run(story, seed))
}

/// Everybody around a world.
struct Camera<'a> {
    scene: &'a SceneFile,
    operator: Operator,
    marker: Marker,
}

impl Camera<'_> {
    fn run(mut self, story: Story, seed: u64) -> Recording {
        let mut world = World::new(self.scene, seed);
        let floor_mm = self.scene.slip_floor_mm_s();
        let mut drive = MotorDrive::Coast;
        let (mut steps, mut samples) = (Vec::new(), [0; ARRAY_COUNT]);
        let (mut rubbed_mm, mut since_s, mut height_mm) = (0.0, 0.0, 0.0);
        for sequence in 0.. {
            if world.now_s() >= self.scene.duration_s() || world.truth().dropped {
                break;
            }
            let select = Frame::lost(sequence).select();
            let mut scans = [Scan::default(); SCANS_PER_FRAME];
            let mut slips = false;
            for scan in &mut scans {
                *scan = scan_of_pins(&world.scan(drive).codes(), select);
                let touch = world.touch();
                slips = world.slipping();
                if slips {
                    rubbed_mm += touch.rub_m_s() * 1e3 * SCAN_S;
                }
                height_mm -= touch.slide_m_s * 1e3 * SCAN_S;
                let pitch_rad = world.truth().trace.last().map_or(0.0, |row| row.pitch_rad);
                self.marker.see(world.now_s(), height_mm, pitch_rad.to_degrees());
            }
            let frame = Frame::from_scans(sequence, &scans);
            let place = usize::from(frame.slot());
            if let Some(sample) = samples.get_mut(place) {
                *sample = frame.switch_b;
            }
            if place == ARRAY_COUNT - 1 {
                let t_s = world.now_s();
                steps.push(Step {
                    t_s,
                    samples,
                    slips: rubbed_mm > floor_mm * (t_s - since_s),
                    marker_slips: false,
                });
                (rubbed_mm, since_s) = (0.0, t_s);
            }
            drive = self.operator.drive(&world, slips);
        }
        let seen = self.marker.slips();
        for step in &mut steps {
            step.marker_slips =
                seen.get(Marker::image_at(step.t_s)).or(seen.last()).is_some_and(|slips| *slips);
        }
        let truth = world.truth();
        Recording {
            story,
            steps,
            spans: fate::spans(truth),
            slid_mm: truth.slips.iter().map(|slip| slip.distance_mm).sum(),
            dropped: truth.dropped,
        }
    }
}
