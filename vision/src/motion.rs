//! An object's rigid move from one picture to the next, by least squares on the brightness (Lucas and Kanade 1981), with a common gain of
//! the light. Pixels that the move does not explain (a spot of the background, a reflection) count less in each round.

use crate::frame::{HEIGHT, PIXELS, Plane, Point, WIDTH};
use crate::mask::Mask;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flow {
    pub x: f32,
    pub y: f32,
    pub turn: f32,
}

pub const ARM_PX: f32 = 60.0;
/// Slope below which a pixel is noise, grey levels over two pixels.
const SLOPE_MIN: i32 = 8;
/// Pixels with a slope that are needed.
const PIXELS_MIN: usize = 60;
/// Pixels that are looked at: of more, every second, third, ... one.
const SAMPLES_MAX: usize = PIXELS * 4 / 75;
const LANES: usize = 8;
const ROUNDS: usize = 3;
/// A change that is not explained and is less than this counts as the rest does, grey levels.
const NOISE: f32 = 4.0;
/// Unknowns: right, down, turn, gain.
const UNKNOWNS: usize = 4;
const CARRIED_MAX: f32 = 1.5;
/// A pivot below this part of its diagonal says that the unknowns cannot be told apart.
const PIVOT_MIN: f32 = 0.02;

impl Flow {
    pub fn slip_on(self, skin: Self) -> f32 {
        let size = skin.x * skin.x + skin.y * skin.y;
        let along = self.x * skin.x + self.y * skin.y;
        let carried = if size > 0.0 { (along / size).clamp(1.0, CARRIED_MAX) } else { 0.0 };
        libm::hypotf(self.x - carried * skin.x, self.y - carried * skin.y) + (self.turn - skin.turn).abs()
    }
}

/// The move that best explains how the pixels of `object` changed, about `middle`. None if they are too plain for that. Right for
/// moves of a pixel or two; larger ones come out too small, with the right sign.
pub fn flow(before: &Plane, now: &Plane, object: &Mask, middle: Point) -> Option<Flow> {
    let mut samples = Samples::EMPTY;
    let (every, mut number) = (object.count() as usize / SAMPLES_MAX + 1, 0);
    object.for_each(|at| {
        number += 1;
        if number % every == 0 {
            samples.take(before, now, at, middle);
        }
    });
    if samples.count < PIXELS_MIN {
        return None;
    }
    let mut found = [0.0; UNKNOWNS];
    for round in 0..ROUNDS {
        let (a, b) = samples.normal_equations((round > 0).then_some(&found));
        found = solve(a, b)?;
    }
    let [x, y, turn, _] = found;
    Some(Flow { x, y, turn })
}

#[inline]
fn around(plane: &Plane, at: usize) -> [i32; 9] {
    let Some(near) = plane.get(at - WIDTH - 1..).and_then(|rest| rest.first_chunk::<{ 2 * WIDTH + 3 }>())
    else {
        return [0; 9];
    };
    std::array::from_fn(|place| i32::from(near[place / 3 * WIDTH + place % 3]))
}

#[inline]
fn slope([a, b, c, d, _, f, g, h, i]: [i32; 9]) -> (i32, i32) {
    (c + 2 * f + i - a - 2 * d - g, g + 2 * h + i - a - 2 * b - c)
}

#[inline]
fn sum([a, b, c, d, e, f, g, h, i]: [i32; 9]) -> i32 {
    a + c + g + i + 2 * (b + d + f + h) + 4 * e
}

struct Samples {
    rows: [[f32; SAMPLES_MAX]; UNKNOWNS],
    changes: [f32; SAMPLES_MAX],
    count: usize,
}

impl Samples {
    const EMPTY: Self = Self { rows: [[0.0; SAMPLES_MAX]; UNKNOWNS], changes: [0.0; SAMPLES_MAX], count: 0 };

    /// Takes a pixel, unless it is plain or at the border.
    #[inline]
    fn take(&mut self, before: &Plane, now: &Plane, at: usize, middle: Point) {
        let (x, y) = (at % WIDTH, at / WIDTH);
        if x == 0 || y == 0 || x == WIDTH - 1 || y == HEIGHT - 1 || self.count == SAMPLES_MAX {
            return;
        }
        // The slope of one picture alone would be off by half the move, and noise in it makes a move look small.
        let (now, before) = (around(now, at), around(before, at));
        let both = std::array::from_fn(|place| now[place] + before[place]);
        let (gx, gy) = slope(both);
        if gx.abs() + gy.abs() < 8 * SLOPE_MIN {
            return;
        }
        let (gx, gy) = (gx as f32 / 16.0, gy as f32 / 16.0);
        let change = sum(std::array::from_fn(|place| now[place] - before[place])) as f32 / 16.0;
        let (dx, dy) = ((x as f32 - middle.x) / ARM_PX, (y as f32 - middle.y) / ARM_PX);
        let row = [-gx, -gy, gx * dy - gy * dx, both[4] as f32 / 512.0];
        self.rows.iter_mut().zip(row).for_each(|(column, value)| column[self.count] = value);
        self.changes[self.count] = change;
        self.count += 1;
    }

    /// The sums of the least squares; what `found` does not explain counts less. Lanes are added up apart, for the compiler's vectors.
    fn normal_equations(
        &self,
        found: Option<&[f32; UNKNOWNS]>,
    ) -> ([[f32; UNKNOWNS]; UNKNOWNS], [f32; UNKNOWNS]) {
        let (mut a, mut b) = ([[[0.0f32; LANES]; UNKNOWNS]; UNKNOWNS], [[0.0f32; LANES]; UNKNOWNS]);
        // Samples past the last are 0.
        for first in (0..self.count).step_by(LANES) {
            let lanes = |column: &[f32; SAMPLES_MAX]| -> [f32; LANES] {
                std::array::from_fn(|lane| column[first + lane])
            };
            let (rows, change) = (self.rows.each_ref().map(lanes), lanes(&self.changes));
            let mut weight = [1.0; LANES];
            if let Some(found) = found {
                for lane in 0..LANES {
                    let told = (0..UNKNOWNS).map(|i| rows[i][lane] * found[i]).sum::<f32>();
                    let off = (change[lane] - told) / NOISE;
                    weight[lane] = 1.0 / (1.0 + off * off);
                }
            }
            for i in 0..UNKNOWNS {
                let own: [f32; LANES] = std::array::from_fn(|lane| weight[lane] * rows[i][lane]);
                let add = |sums: &mut [f32; LANES], of: &[f32; LANES]| {
                    (0..LANES).for_each(|lane| sums[lane] += own[lane] * of[lane]);
                };
                (0..=i).for_each(|j| add(&mut a[i][j], &rows[j]));
                add(&mut b[i], &change);
            }
        }
        (a.map(|row| row.map(|lanes| lanes.iter().sum())), b.map(|lanes| lanes.iter().sum()))
    }
}

/// Solves the normal equations by Cholesky's factors. None if the unknowns cannot be told apart.
fn solve(mut a: [[f32; UNKNOWNS]; UNKNOWNS], mut b: [f32; UNKNOWNS]) -> Option<[f32; UNKNOWNS]> {
    for i in 0..UNKNOWNS {
        for j in 0..=i {
            let dot: f32 = (0..j).map(|k| a[i][k] * a[j][k]).sum();
            let left = a[i][j] - dot;
            if i == j {
                if left <= PIVOT_MIN * a[i][i] {
                    return None;
                }
                a[i][i] = libm::sqrtf(left);
            } else {
                a[i][j] = left / a[j][j];
            }
        }
        b[i] = (b[i] - (0..i).map(|k| a[i][k] * b[k]).sum::<f32>()) / a[i][i];
    }
    for i in (0..UNKNOWNS).rev() {
        b[i] = (b[i] - (i + 1..UNKNOWNS).map(|k| a[k][i] * b[k]).sum::<f32>()) / a[i][i];
    }
    Some(b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::plane;

    const MIDDLE: Point = Point { x: 150.0, y: 110.0 };

    fn object() -> Mask {
        let mut object = Mask::EMPTY;
        object.insert_block(80..240, 60..180);
        object
    }

    fn draw(moved: Flow, gain: f32, into: &mut Plane) {
        let (sin, cos) = (libm::sinf(moved.turn / ARM_PX), libm::cosf(moved.turn / ARM_PX));
        for (at, level) in into.iter_mut().enumerate() {
            let (dx, dy) =
                ((at % WIDTH) as f32 - MIDDLE.x - moved.x, (at / WIDTH) as f32 - MIDDLE.y - moved.y);
            let (px, py) = (dx * cos + dy * sin, dy * cos - dx * sin);
            *level = (gain * (128.0 + 50.0 * libm::sinf(px / 5.0) + 50.0 * libm::cosf(py / 6.0))) as u8;
        }
    }

    #[test]
    fn a_move_is_measured_and_a_plain_object_says_nothing() {
        let (mut before, mut now) = (plane(), plane());
        draw(Flow::default(), 1.0, &mut before);
        assert_eq!(flow(&plane(), &plane(), &object(), MIDDLE), None);
        for (x, y, turn) in
            [(0.0, 0.0, 0.0), (0.5, -0.3, 0.0), (-1.0, 1.5, 0.4), (0.0, 2.0, -1.0), (0.0, 0.0, 0.2)]
        {
            for gain in [1.0, 1.02, 0.98] {
                draw(Flow { x, y, turn }, gain, &mut now);
                let found = flow(&before, &now, &object(), MIDDLE).unwrap();
                let off = found.slip_on(Flow { x, y, turn });
                assert!(off < 0.15, "{x} {y} {turn} {gain}: {found:?}");
            }
        }
    }

    #[test]
    fn what_the_skin_carries_does_not_slip() {
        let skin = Flow { x: 0.6, y: -0.3, turn: 0.0 };
        let carried = |part: f32| Flow { x: part * skin.x, y: part * skin.y, turn: 0.0 }.slip_on(skin);
        assert!(carried(1.0) < 1e-6 && carried(1.4) < 1e-6);
        assert!(carried(2.0) > 0.3 && carried(0.0) > 0.6 && carried(-1.0) > 1.3);
        assert!(Flow { x: 0.6, y: 0.3, turn: 0.0 }.slip_on(skin) > 0.25, "across it");
        assert!(Flow { turn: 0.5, ..skin }.slip_on(skin) >= 0.5, "a turn");
        assert_eq!(Flow::default().slip_on(Flow::default()), 0.0);
    }

    #[test]
    fn a_spot_of_what_lies_behind_does_not_move_it() {
        let (mut before, mut now, mut other) = (plane(), plane(), plane());
        draw(Flow::default(), 1.0, &mut before);
        now.copy_from_slice(&before[..]);
        draw(Flow { x: 2.0, y: -1.5, turn: 0.0 }, 1.0, &mut other);
        for y in 60..90 {
            now[y * WIDTH + 80..y * WIDTH + 150].copy_from_slice(&other[y * WIDTH + 80..y * WIDTH + 150]);
        }
        let found = flow(&before, &now, &object(), MIDDLE).unwrap();
        assert!(found.slip_on(Flow::default()) < 0.1, "{found:?}");
    }
}
