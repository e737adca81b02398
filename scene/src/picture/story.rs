//! The story in front of the camera: an object comes, is grasped, held, slips, is pulled and turned, and goes.

use crate::random::Noise;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    pub object: (f64, f64),
    /// The object's angle, radians from x towards y (down).
    pub angle_rad: f64,
    pub shear_px: (f64, f64),
    pub press_px: f64,
    pub background: (f64, f64),
    pub exposure: f64,
}

#[derive(Clone, Debug)]
pub struct Story {
    from: (f64, f64),
    held: (f64, f64),
    angle_rad: f64,
    press_px: f64,
    shears: [(f64, f64); 3],
    slides: [(f64, f64); 2],
    turn_rad: f64,
    hand_px: f64,
    exposure: (f64, f64),
}

pub const COMES_S: f64 = 1.0;
pub const GRASPED_S: f64 = 2.0;
pub const LET_GO_S: f64 = 8.0;
pub const GONE_S: f64 = 9.0;
pub const END_S: f64 = 10.0;
pub const SLIDES_S: [(f64, f64); 2] = [(3.0, 3.4), (5.0, 5.5)];
pub const TURN_S: (f64, f64) = (6.6, 7.2);
const SHEARS_S: [f64; 3] = [2.4, 4.1, 6.0];
pub const HAND_S: [(f64, f64); 3] = [(0.5, 0.9), (4.0, 4.8), (7.3, 7.9)];

fn smooth(t_s: f64, from_s: f64, to_s: f64) -> f64 {
    let part = ((t_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0);
    part * part * (3.0 - 2.0 * part)
}

impl Story {
    pub(crate) fn drawn(noise: &mut Noise, speed: f64) -> Self {
        let side = noise.sign();
        let mut shear = || (noise.between(-3.0, 3.0), noise.between(-3.0, 3.0));
        let shears = [shear(), shear(), shear()];
        Self {
            from: (160.0 + side * 380.0, noise.between(60.0, 180.0)),
            held: (noise.between(145.0, 175.0), noise.between(108.0, 132.0)),
            angle_rad: noise.between(-1.5, 1.5),
            press_px: noise.between(1.0, 3.0),
            shears,
            slides: [
                (noise.between(-14.0, 14.0), noise.sign() * noise.between(6.0, 16.0)),
                (noise.sign() * noise.between(6.0, 16.0), noise.between(-14.0, 14.0)),
            ]
            .map(|(x, y)| (x * speed, y * speed)),
            turn_rad: noise.sign() * noise.between(0.2, 0.35) * speed,
            hand_px: noise.between(20.0, 60.0),
            exposure: (noise.between(0.0, 0.06), noise.between(0.1, 0.5)),
        }
    }

    pub fn at(&self, t_s: f64) -> State {
        let near = smooth(t_s, COMES_S, GRASPED_S - 0.1) - smooth(t_s, LET_GO_S + 0.1, GONE_S);
        let mut object = (
            self.from.0 + (self.held.0 - self.from.0) * near,
            self.from.1 + (self.held.1 - self.from.1) * near,
        );
        let mut angle_rad = self.angle_rad;
        for ((from_s, to_s), (x, y)) in SLIDES_S.into_iter().zip(self.slides) {
            let part = smooth(t_s, from_s, to_s);
            object = (object.0 + x * part, object.1 + y * part);
        }
        angle_rad += self.turn_rad * smooth(t_s, TURN_S.0, TURN_S.1);
        let gripped = smooth(t_s, GRASPED_S, GRASPED_S + 0.3) - smooth(t_s, LET_GO_S - 0.3, LET_GO_S);
        let mut shear_px = (0.0, 0.0);
        for (from_s, (x, y)) in SHEARS_S.into_iter().zip(self.shears) {
            let part = smooth(t_s, from_s, from_s + 0.2) * gripped;
            shear_px = (shear_px.0 + x * part, shear_px.1 + y * part);
        }
        // What sticks to the skin moves with it.
        object = (object.0 + shear_px.0, object.1 + shear_px.1);
        let hand: f64 = HAND_S.iter().map(|&(from_s, to_s)| smooth(t_s, from_s, to_s)).sum();
        State {
            object,
            angle_rad,
            shear_px,
            press_px: self.press_px * gripped,
            background: (0.3 * self.hand_px * hand, self.hand_px * hand),
            exposure: 1.0 + self.exposure.0 * libm::sin(std::f64::consts::TAU * self.exposure.1 * t_s),
        }
    }

    pub fn slides(t_s: f64) -> bool {
        SLIDES_S.iter().chain([&TURN_S]).any(|&(from_s, to_s)| (from_s..to_s).contains(&t_s))
    }

    pub fn gripped(t_s: f64) -> bool {
        (GRASPED_S + 0.3..LET_GO_S - 0.3).contains(&t_s)
    }
}
