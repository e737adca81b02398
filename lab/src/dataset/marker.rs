//! The marker on the box and the camera that sees it: Bamshad's labels (section 3.2, figure 4).
//!
//! The paper takes "the moving-average information" of the marker's pitch and height and says no more; rate, noise, window
//! and thresholds are assumed here. The camera is fixed to the gripper.

use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Images a second (assumed, as of Tada 2006).
const IMAGE_HZ: f64 = 30.0;
/// Noise of the marker's height, rms, mm, and of its pitch, degrees (assumed: corners to a tenth of a pixel).
const HEIGHT_NOISE_MM: f64 = 0.1;
const PITCH_NOISE_DEG: f64 = 0.2;
/// Images in the moving average, an odd number: its middle is its time.
const AVERAGED: usize = 5;
/// The average moves faster than this: it slips, mm/s and degrees/s.
const HEIGHT_MM_S: f64 = 2.5;
const PITCH_DEG_S: f64 = 5.0;

/// What the camera saw, image by image.
#[derive(Debug)]
pub struct Marker {
    rng: ChaCha8Rng,
    height_mm: Vec<f64>,
    pitch_deg: Vec<f64>,
}

impl Marker {
    /// A camera with its own noise.
    pub const fn new(rng: ChaCha8Rng) -> Self {
        Self { rng, height_mm: Vec::new(), pitch_deg: Vec::new() }
    }

    /// Shows it the box; it takes an image when one is due.
    pub fn see(&mut self, t_s: f64, height_mm: f64, pitch_deg: f64) {
        if t_s * IMAGE_HZ < self.height_mm.len() as f64 {
            return;
        }
        let mut noise = |rms: f64| -> f64 {
            let draw: f64 = StandardNormal.sample(&mut self.rng);
            rms * draw
        };
        let (height_noise, pitch_noise) = (noise(HEIGHT_NOISE_MM), noise(PITCH_NOISE_DEG));
        self.height_mm.push(height_mm + height_noise);
        self.pitch_deg.push(pitch_deg + pitch_noise);
    }

    /// Whether each image shows slip.
    pub fn slips(&self) -> Vec<bool> {
        let [height, pitch] = [&self.height_mm, &self.pitch_deg].map(|track| speeds(track));
        height.iter().zip(pitch).map(|(mm_s, deg_s)| *mm_s > HEIGHT_MM_S || deg_s > PITCH_DEG_S).collect()
    }

    /// The image that shows an instant.
    pub fn image_at(t_s: f64) -> usize {
        (t_s * IMAGE_HZ).round() as usize
    }
}

/// How fast the moving average of a track moves at each image, a second: from the image before to the one after.
fn speeds(track: &[f64]) -> Vec<f64> {
    let last = track.len().saturating_sub(1);
    let average = |at: usize| {
        let window = &track[at.saturating_sub(AVERAGED / 2)..=(at + AVERAGED / 2).min(last)];
        window.iter().sum::<f64>() / window.len() as f64
    };
    let speed = |at: usize| {
        let (before, after) = (at.saturating_sub(1), (at + 1).min(last));
        let for_s = (after - before).max(1) as f64 / IMAGE_HZ;
        (average(after) - average(before)).abs() / for_s
    };
    (0..track.len()).map(speed).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    fn watched(height_mm: impl Fn(f64) -> f64, pitch_deg: impl Fn(f64) -> f64) -> Vec<bool> {
        let mut marker = Marker::new(ChaCha8Rng::seed_from_u64(1));
        for n in 0..16_000 {
            let t_s = f64::from(n) / 8e3;
            marker.see(t_s, height_mm(t_s), pitch_deg(t_s));
        }
        marker.slips()
    }

    #[test]
    fn what_rests_does_not_slip_and_what_sinks_or_turns_does() {
        assert!(watched(|_| 0.0, |_| 0.0).iter().filter(|slips| **slips).count() <= 1);
        for slips in [watched(|t_s| -8.0 * t_s, |_| 0.0), watched(|_| 0.0, |t_s| 15.0 * t_s)] {
            assert!(slips.iter().filter(|slips| **slips).count() > 55, "{slips:?}");
        }
    }

    #[test]
    fn the_average_blurs_an_onset_by_its_own_window() {
        let slips = watched(|t_s| -20.0 * (t_s - 1.0).max(0.0), |_| 0.0);
        let first = slips.iter().position(|slips| *slips).expect("it slips");
        assert!((27..=31).contains(&first), "image {first}");
    }
}
