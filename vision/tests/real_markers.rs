//! The markers of the real sensor, beside what its author's software makes of the same video.

use std::collections::HashMap;

use crate::common::{for_each_frame, plane, recording};
use tenax_vision::Point;
use tenax_vision::markers::{Calibration, Markers};

fn authors(path: &std::path::Path) -> HashMap<(usize, usize), Point> {
    let text = std::fs::read_to_string(path).expect("readable");
    let mut last = HashMap::new();
    let rows = text.lines().skip(1).filter_map(|line| {
        let mut fields = line.split(',').map(|field| field.parse::<f32>().expect("a number"));
        let mut next = || fields.next().expect("a field");
        let (frame, marker) = (next() as usize, next() as usize);
        let at = Point { x: next(), y: next() };
        (last.insert(marker, at) != Some(at)).then_some(((frame, marker), at))
    });
    rows.collect()
}

#[test]
#[cfg_attr(not(videos), ignore = "no video in ../shared/data, or no ffmpeg")]
fn the_real_video_gives_its_markers() {
    let (video, table) = (recording("skin_video_54fps.m4v"), recording("author_markers.csv"));
    let authors = authors(&table);
    let (mut grey, mut calibration, mut markers) = (plane(0), Calibration::default(), None::<Markers>);
    let mut pairs: Vec<(usize, usize)> = Vec::new();
    let mut last: Vec<Option<Point>> = Vec::new();
    let (mut updates, mut failed, mut worst_jump) = (0, 0, 0.0f32);
    let (mut offs, mut frames) = (Vec::new(), 0);
    for_each_frame(&video, |number, frame| {
        frame.grey(&mut grey);
        frames += 1;
        let Some(markers) = &mut markers else {
            if calibration.frame(&grey) {
                let found = Markers::new(&calibration);
                for author in 0..23 {
                    let Some(at) = (0..30).find_map(|frame| authors.get(&(frame, author))) else { continue };
                    let near = found.iter().position(|marker| marker.at.distance(*at) < 4.0);
                    pairs.extend(near.map(|near| (near, author)));
                }
                last = vec![None; found.len()];
                markers = Some(found);
            }
            return;
        };
        markers.follow(&grey);
        for (marker, last) in markers.iter().zip(&mut last) {
            updates += 1;
            failed += usize::from(marker.found.is_err());
            if marker.known() {
                worst_jump = last.map_or(worst_jump, |last| worst_jump.max(last.distance(marker.at)));
                *last = Some(marker.at);
            }
        }
        for &(own, author) in &pairs {
            let Some(at) = authors.get(&(number, author)) else { continue };
            if markers[own].found.is_ok() {
                offs.push(markers[own].at.distance(*at));
            }
        }
    });
    let count = markers.map_or(0, |markers| markers.len());
    let share = failed as f32 / updates as f32;
    offs.sort_unstable_by(f32::total_cmp);
    let rms = (offs.iter().map(|off| off * off).sum::<f32>() / offs.len() as f32).sqrt();
    let within = offs.partition_point(|&off| off <= 0.5) as f32 / offs.len() as f32;
    println!(
        "{frames} frames, {count} markers, {} of the author's 23, {:.2} % failed, longest jump {worst_jump:.2} px, beside the \
         author's: {rms:.3} px rms, {:.1} % within 0.5 px",
        pairs.len(),
        100.0 * share,
        100.0 * within,
    );
    assert!(frames > 2900 && count >= 23 && pairs.len() >= 22);
    assert!(share < 0.10);
    assert!(worst_jump <= 3.0);
    assert!(rms <= 0.5 && within > 0.93);
}
