//! The object in the real video, beside outlines of the cards that were drawn by hand.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::common::{for_each_frame, plane, recording};
use tenax_vision::frame::{HEIGHT, WIDTH};
use tenax_vision::mask::Mask;
use tenax_vision::object::Tracker;

/// Frames without card or hand; a person walks about behind the skin in the first and in the last.
const EMPTY: [Range<usize>; 3] = [0..260, 1540..1640, 2660..2932];

fn outlines() -> BTreeMap<usize, Vec<(f32, f32)>> {
    let rows = include_str!("outlines/cards.csv").lines().filter(|line| !line.starts_with('#'));
    let rows =
        rows.map(|line| line.split(',').map(|field| field.parse().expect("a number")).collect::<Vec<f32>>());
    rows.map(|row| (row[0] as usize, row[1..].chunks(2).map(|corner| (corner[0], corner[1])).collect()))
        .collect()
}

/// Pixels in both object and outline, as a share of those in either.
fn overlap(object: &Mask, corners: &[(f32, f32)]) -> f32 {
    let (mut both, mut either) = (0, 0);
    for (x, y) in (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y))) {
        let (px, py) = (x as f32, y as f32);
        let sides = corners.iter().zip(corners.iter().cycle().skip(1));
        let crossings = sides.filter(|((ax, ay), (bx, by))| {
            (*ay > py) != (*by > py) && px < (bx - ax) * (py - ay) / (by - ay) + ax
        });
        let is_in = [object.contains(x, y), crossings.count() % 2 == 1];
        both += u32::from(is_in == [true; 2]);
        either += u32::from(is_in != [false; 2]);
    }
    both as f32 / either.max(1) as f32
}

#[test]
#[cfg_attr(not(videos), ignore = "no video in ../shared/data, or no ffmpeg")]
fn both_cards_are_outlined_and_the_empty_scene_is_empty() {
    let video = recording("skin_video_54fps.m4v");
    let outlines = outlines();
    assert_eq!(outlines.len(), 20);
    let (mut grey, mut tracker) = (plane(0), Tracker::default());
    let (mut empty, mut wrong, mut slips, mut held) = (0, 0, 0, 0);
    let mut overlaps = Vec::new();
    for_each_frame(&video, |number, frame| {
        frame.grey(&mut grey);
        let sighting = tracker.step(&frame, &grey, &Mask::EMPTY, true);
        if EMPTY.iter().any(|range| range.contains(&number)) {
            empty += 1;
            wrong += usize::from(sighting.is_some());
        }
        // The hand turns and moves the printed card.
        if (1700..2600).contains(&number) {
            held += 1;
            slips += usize::from(sighting.is_some_and(|sighting| sighting.slip_px > 100));
        }
        if let Some(outline) = outlines.get(&number) {
            overlaps.push((number, overlap(tracker.object(), outline)));
        }
    });
    let mean = overlaps.iter().map(|(_, overlap)| overlap).sum::<f32>() / overlaps.len() as f32;
    let worst = overlaps.iter().map(|(_, overlap)| *overlap).fold(1.0, f32::min);
    println!(
        "something seen in {wrong} of {empty} empty frames; outlines: {mean:.2} mean, {worst:.2} worst {overlaps:.2?}; \
         moving points in {slips} of {held} frames in which a card is moved"
    );
    assert!(slips * 100 > held * 85, "{slips} of {held}");
    assert!(wrong * 100 <= empty, "{wrong} of {empty}");
    assert!(mean >= 0.75 && worst >= 0.6, "{mean} {worst}");
}
