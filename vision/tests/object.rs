//! An object that is drawn before a background of its own colours, moved, held and taken away.

use crate::common::{Noise, plane};
use tenax_vision::frame::{Frame, PIXELS, Plane, WIDTH};
use tenax_vision::mask::Mask;
use tenax_vision::object::{Sighting, Tracker};

#[derive(Clone, Copy)]
struct Rod {
    middle: (f32, f32),
    angle_rad: f32,
}

/// The picture of a rod of stripes before a wall of patches, which is moved by `wall` px.
struct World {
    noise: Noise,
    planes: [Box<Plane>; 3],
}

impl World {
    fn new(seed: u64) -> Self {
        Self { noise: Noise(seed), planes: [plane(0), plane(0), plane(0)] }
    }

    fn draw(&mut self, rod: Option<Rod>, wall: f32) -> Frame<'_> {
        let [red, green, blue] = &mut self.planes;
        for at in 0..PIXELS {
            let (x, y) = ((at % WIDTH) as f32, (at / WIDTH) as f32);
            let patch = ((x + wall) / 37.0).sin() + (y / 29.0).sin();
            let mut colour = [150.0 + 40.0 * patch, 150.0 + 30.0 * patch, 130.0 + 30.0 * patch];
            if let Some(rod) = rod {
                let (sin, cos) = rod.angle_rad.sin_cos();
                let (dx, dy) = (x - rod.middle.0, y - rod.middle.1);
                let (along, across) = (dx * cos + dy * sin, dy * cos - dx * sin);
                if along.abs() < 75.0 && across.abs() < 20.0 {
                    let stripe = if (along / 6.0).floor() as i32 % 2 == 0 { 30.0 } else { 0.0 };
                    colour = [60.0 + stripe, 90.0 + stripe, 170.0 - stripe];
                }
            }
            let grain = 2.0 * self.noise.normal();
            [red[at], green[at], blue[at]] = colour.map(|level| (level + grain).clamp(0.0, 255.0) as u8);
        }
        Frame { red, green, blue }
    }
}

struct Camera {
    world: World,
    tracker: Tracker,
    grey: Box<Plane>,
}

impl Camera {
    fn new(seed: u64) -> Self {
        let tracker = Tracker::default();
        let mut camera = Self { world: World::new(seed), tracker, grey: plane(0) };
        (0..20).for_each(|_| assert!(camera.look(None, 0.0, true).is_none()));
        camera
    }

    fn look(&mut self, rod: Option<Rod>, wall: f32, learn: bool) -> Option<Sighting> {
        let frame = self.world.draw(rod, wall);
        frame.grey(&mut self.grey);
        self.tracker.step(&frame, &self.grey, &Mask::EMPTY, learn)
    }

    fn bring(&mut self, angle_rad: f32) -> Rod {
        let at = |x: f32| Rod { middle: (x, 120.0), angle_rad };
        for step in 0..40 {
            self.look(Some(at(160.0 + 5.0 * (40 - step) as f32)), 0.0, true);
        }
        (0..20).for_each(|_| _ = self.look(Some(at(160.0)), 0.0, false));
        at(160.0)
    }
}

#[test]
fn a_rod_is_found_with_its_place_and_angle_and_does_not_slip_while_it_is_held() {
    for (seed, degrees) in [(1, 0.0f32), (2, 30.0), (3, -55.0), (4, 80.0)] {
        let mut camera = Camera::new(seed);
        let rod = camera.bring(degrees.to_radians());
        for frame in 0..300 {
            let seen = camera.look(Some(rod), 0.0, false).expect("still there");
            let off = (seen.moments.angle_rad() - rod.angle_rad).to_degrees();
            assert!(off.abs() < 2.0, "{degrees} degrees: off by {off} in frame {frame}");
            assert!(
                (seen.moments.middle.x - 160.0).abs() < 2.0
                    && (seen.area * PIXELS as f32 - 6000.0).abs() < 900.0
            );
            assert!(seen.slip_px < 20 && !seen.cut, "{} px slip", seen.slip_px);
        }
    }
}

#[test]
fn a_rod_that_slides_slips_and_one_that_leaves_is_gone() {
    let mut camera = Camera::new(5);
    let mut rod = camera.bring(0.3);
    for _ in 0..10 {
        rod.middle.0 += 1.5;
        let seen = camera.look(Some(rod), 0.0, false).expect("there");
        assert!(seen.slip_px > 150, "{}", seen.slip_px);
    }
    let left: Vec<bool> = (0..60).map(|_| camera.look(None, 0.0, false).is_some()).collect();
    assert!(left[5..].iter().all(|&seen| !seen), "{left:?}");
}

#[test]
fn a_wall_that_moves_is_no_object_and_no_slip() {
    let mut camera = Camera::new(6);
    let moved: usize =
        (0..60).map(|step| usize::from(camera.look(None, 2.0 * step as f32, false).is_some())).sum();
    assert_eq!(moved, 0);
    // Nor behind a rod that is held still: its own stripes do not move.
    let mut camera = Camera::new(7);
    let rod = camera.bring(0.3);
    let slips: Vec<u32> = (0..60)
        .map(|step| camera.look(Some(rod), 2.0 * step as f32, false).map_or(0, |seen| seen.slip_px))
        .collect();
    let loud = slips.iter().filter(|&&slip| slip > 300).count();
    assert!(loud <= 3, "{slips:?}");
}

#[test]
fn an_object_beyond_the_border_says_so() {
    let mut camera = Camera::new(8);
    let mut rod = camera.bring(0.0);
    for _ in 0..60 {
        rod.middle.0 += 2.0;
        camera.look(Some(rod), 0.0, true);
    }
    assert!(camera.look(Some(rod), 0.0, true).expect("half of it").cut);
}
