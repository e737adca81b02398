//! Surfaces: colours that vary smoothly in patches, and sharp marks on them. Made once, then looked up.

use crate::random::Noise;

const SIDE: usize = 512;

#[derive(Clone, Debug)]
pub struct Texture {
    pixels: Vec<[f32; 3]>,
}

impl Texture {
    pub(crate) fn drawn(noise: &mut Noise, base: [f64; 3], contrast: f64, marks: usize) -> Self {
        let mut waves = Vec::new();
        for _ in 0..9 {
            // Whole waves over the side, so that it repeats without a seam.
            let (kx, ky) = (noise.between(-6.0, 6.0).round(), noise.between(-6.0, 6.0).round());
            let tint = [0.0; 3].map(|_: f64| noise.between(0.6, 1.0));
            waves.push((kx, ky, noise.between(0.0, 6.3), noise.between(0.3, 1.0), tint));
        }
        let turn = std::f64::consts::TAU / SIDE as f64;
        let mut pixels: Vec<[f32; 3]> = (0..SIDE * SIDE)
            .map(|at| {
                let (x, y) = ((at % SIDE) as f64, (at / SIDE) as f64);
                let mut colour = base;
                for (kx, ky, phase, size, tint) in &waves {
                    let wave = contrast * size * libm::sin(turn * (kx * x + ky * y) + phase) / 3.0;
                    (0..3).for_each(|plane| colour[plane] += wave * tint[plane]);
                }
                colour.map(|level| level as f32)
            })
            .collect();
        for _ in 0..marks {
            let (left, top) =
                (noise.between(0.0, SIDE as f64) as usize, noise.between(0.0, SIDE as f64) as usize);
            let (wide, high) = (noise.between(4.0, 40.0) as usize, noise.between(4.0, 40.0) as usize);
            let shift = [0.0; 3].map(|_: f64| (noise.between(-1.2, 1.2) * contrast) as f32);
            for y in top..top + high {
                for x in left..left + wide {
                    let pixel = &mut pixels[y % SIDE * SIDE + x % SIDE];
                    (0..3).for_each(|plane| pixel[plane] += shift[plane]);
                }
            }
        }
        Self { pixels }
    }

    pub fn at(&self, x: f64, y: f64) -> [f32; 3] {
        let (left, top) = (x.floor(), y.floor());
        let (right, down) = ((x - left) as f32, (y - top) as f32);
        let place = |x: f64| (x as i64).rem_euclid(SIDE as i64) as usize;
        let (x0, y0) = (place(left), place(top));
        let (x1, y1) = ((x0 + 1) % SIDE, (y0 + 1) % SIDE);
        let of = |x: usize, y: usize| self.pixels[y * SIDE + x];
        let (a, b, c, d) = (of(x0, y0), of(x1, y0), of(x0, y1), of(x1, y1));
        std::array::from_fn(|plane| {
            let upper = a[plane] + (b[plane] - a[plane]) * right;
            let lower = c[plane] + (d[plane] - c[plane]) * right;
            upper + (lower - upper) * down
        })
    }
}
