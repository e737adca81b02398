//! Markers that are drawn where the test says, moved, covered and imitated.

use crate::common::{Noise, draw_discs, plane};
use tenax_vision::Camera;
use tenax_vision::frame::{Frame, PIXELS, Plane};
use tenax_vision::markers::{Calibration, Failure, Markers};

fn discs(shift: impl Fn(f32, f32) -> (f32, f32)) -> Vec<(f32, f32, f32)> {
    let places = (0..35).map(|at| (30.3 + 43.1 * (at % 7) as f32, 24.7 + 47.3 * (at / 7) as f32));
    places.map(|(x, y)| (x + shift(x, y).0, y + shift(x, y).1, 4.3)).collect()
}

fn still(_: f32, _: f32) -> (f32, f32) {
    (0.0, 0.0)
}

fn even(_: f32, _: f32) -> f32 {
    170.0
}

fn stripes(phase: f32) -> impl Fn(f32, f32) -> f32 {
    move |x, y| 130.0 + 60.0 * ((x + 0.6 * y + phase) * std::f32::consts::TAU / 80.0).sin()
}

fn number(markers: &Markers, disc: (f32, f32, f32)) -> usize {
    let near =
        markers.iter().position(|marker| (marker.rest.at.x - disc.0).hypot(marker.rest.at.y - disc.1) < 2.0);
    near.expect("every disc is a marker")
}

fn calibrated(background: impl Fn(f32, f32) -> f32, noise: &mut Noise, grey: &mut Plane) -> Markers {
    let mut calibration = Calibration::default();
    loop {
        draw_discs(&discs(still), &background, 2.0, noise, grey);
        if calibration.frame(grey) {
            return Markers::new(&calibration);
        }
    }
}

#[test]
fn moved_markers_are_found_to_a_tenth_of_a_pixel_though_the_background_moves() {
    let (mut noise, mut grey) = (Noise(5), plane(0));
    let mut markers = calibrated(stripes(0.0), &mut noise, &mut grey);
    assert_eq!(markers.len(), 35);
    let (mut sum, mut count) = (0.0, 0);
    for frame in 1..=60 {
        let part = frame as f32 / 60.0;
        // Sheared to the right and pressed in the middle: five pixels at most.
        let shift = |x: f32, y: f32| {
            let (dx, dy) = (x - 160.0, y - 120.0);
            let press = 0.03 * (-(dx * dx + dy * dy) / 20_000.0).exp();
            (part * (3.0 + press * dx), part * (-1.0 + press * dy))
        };
        draw_discs(&discs(shift), stripes(2.0 * frame as f32), 2.0, &mut noise, &mut grey);
        markers.follow(&grey);
        let truth = discs(shift);
        for marker in markers.iter().filter(|marker| marker.found.is_ok()) {
            let off = truth
                .iter()
                .map(|&(x, y, _)| (marker.at.x - x).hypot(marker.at.y - y))
                .fold(f32::MAX, f32::min);
            (sum, count) = (sum + off * off, count + 1);
        }
    }
    let rms = (sum / count as f32).sqrt();
    assert!(count > 60 * 35 * 97 / 100, "{count} of {}", 60 * 35);
    assert!(rms < 0.1, "{rms} px rms");
}

#[test]
fn a_marker_that_grows_is_a_marker_that_is_pressed() {
    let (mut noise, mut grey) = (Noise(6), plane(0));
    let mut markers = calibrated(even, &mut noise, &mut grey);
    let mut larger = discs(still);
    let pressed = number(&markers, larger[17]);
    larger[17].2 += 0.5;
    draw_discs(&larger, even, 2.0, &mut noise, &mut grey);
    markers.follow(&grey);
    assert!((markers[pressed].growth - 0.5).abs() < 0.12, "{}", markers[pressed].growth);
    assert!(markers[(pressed + 1) % 35].growth.abs() < 0.1);
}

#[test]
fn a_covered_marker_fails_with_its_reason_and_comes_back_on_probation() {
    let (mut noise, mut grey) = (Noise(7), plane(0));
    let mut markers = calibrated(even, &mut noise, &mut grey);
    let rest = discs(still);
    let own = number(&markers, rest[17]);
    let at = markers[own].at;
    let covered = |x: f32, y: f32| (x - at.x).abs() < 20.0 && (y - at.y).abs() < 20.0;
    let without: Vec<_> = rest.iter().copied().filter(|&(x, y, _)| !covered(x, y)).collect();
    for frame in 0..8 {
        draw_discs(&without, even, 2.0, &mut noise, &mut grey);
        markers.follow(&grey);
        assert_eq!(markers[own].found, Err(Failure::DarkPixels), "frame {frame}");
        assert_eq!(markers[own].known(), frame < 3, "frame {frame}");
        assert!(markers[(own + 1) % 35].found.is_ok());
    }
    let seen: Vec<bool> = (0..6)
        .map(|_| {
            draw_discs(&rest, even, 2.0, &mut noise, &mut grey);
            markers.follow(&grey);
            markers[own].known()
        })
        .collect();
    assert_eq!(seen, [false, false, false, true, true, true]);
}

#[test]
fn two_blobs_are_a_failure_and_a_jump_is_no_force() {
    let (mut noise, mut grey) = (Noise(8), plane(0));
    let mut markers = calibrated(even, &mut noise, &mut grey);
    let rest = discs(still);
    let (twin, jumper) = (number(&markers, rest[17]), number(&markers, rest[9]));
    // The marker is gone and two others stand in its window.
    let mut twins = rest.clone();
    twins.remove(17);
    twins.extend([(rest[17].0 - 9.0, rest[17].1, 4.3), (rest[17].0 + 9.0, rest[17].1, 4.3)]);
    draw_discs(&twins, even, 2.0, &mut noise, &mut grey);
    markers.follow(&grey);
    assert_eq!(markers[twin].found, Err(Failure::Blobs));
    // One that is elsewhere at once has jumped.
    let mut jumped = rest.clone();
    jumped[9].0 += 4.0;
    draw_discs(&jumped, even, 2.0, &mut noise, &mut grey);
    markers.follow(&grey);
    assert_eq!(markers[jumper].found, Err(Failure::Moved));
    assert!(markers[jumper].moved().0.abs() < 0.2);
    // And one that creeps away from its neighbours is something else.
    let mut markers = calibrated(even, &mut noise, &mut grey);
    let own = number(&markers, rest[17]);
    let mut strayed = None;
    for step in 1..8 {
        let mut creeping = rest.clone();
        creeping[17].0 += step as f32;
        draw_discs(&creeping, even, 2.0, &mut noise, &mut grey);
        markers.follow(&grey);
        strayed = strayed.or(markers[own].found.err());
        assert!(markers[own].moved().0 < 3.0);
    }
    assert_eq!(strayed, Some(Failure::Apart));
}

#[test]
fn what_moves_or_is_not_round_is_no_marker() {
    let (mut noise, mut grey) = (Noise(9), plane(0));
    let mut calibration = Calibration::default();
    loop {
        let mut drawn = discs(still);
        // One that moves, and one that is two discs in one.
        drawn[8].0 += noise.even() * 3.0;
        let (x, y, _) = drawn[20];
        drawn.push((x + 6.0, y, 4.3));
        draw_discs(&drawn, even, 2.0, &mut noise, &mut grey);
        if calibration.frame(&grey) {
            break;
        }
    }
    let markers = Markers::new(&calibration);
    let rest = discs(still);
    let has = |at: usize| {
        markers.iter().any(|marker| (marker.at.x - rest[at].0).hypot(marker.at.y - rest[at].1) < 5.0)
    };
    assert!(!has(8) && !has(20) && has(9), "{} markers", markers.len());
    assert_eq!(markers.len(), 33);
}

#[test]
fn grey_first_pictures_cost_no_marker_and_invent_no_object() {
    for greys in [0, 1, 15] {
        let (mut noise, mut grey, mut camera) = (Noise(9), plane(0), Camera::default());
        let mut seen = Vec::new();
        for number in 0..100_u32 {
            draw_discs(&discs(still), stripes(0.0), 2.0, &mut noise, &mut grey);
            if number < greys {
                grey[100 * 320..].fill(128);
            }
            let planes = [&grey[..]; 3].concat();
            let frame = Frame::from_gbrp(&planes).unwrap();
            let summary = camera.picture(&frame, true, 33 * number, 33 * number);
            seen.push((summary.markers, summary.object.is_some()));
        }
        assert_eq!(PIXELS, 320 * 240);
        assert!(seen[60..].iter().all(|&own| own == (35, false)), "{greys} grey: {seen:?}");
    }
}
