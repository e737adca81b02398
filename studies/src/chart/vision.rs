//! The charts of `tenax chart vision`: what each way of finding the object costs and how well it outlines real cards; and how
//! well known loads on a real skin are told, with the reason why normal force is not told better.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result};
use tenax_serial::quantile::middle;
use tenax_vision::frame::{Frame, Plane, plane};
use tenax_vision::mask::Mask;
use tenax_vision::object::{Config, Running, Tracker};

use super::{Chart, Progress, csv};
use crate::vision::feed::{Feed, Next};
use crate::vision::source::Source;
use tenax_plot::figure::colour;
use tenax_plot::sheet::{Axis, Mark, Panel, Series, Sheet};

/// The cards' outlines in the real video, by hand.
const OUTLINES: &str = include_str!("../../../vision/tests/outlines/cards.csv");
/// Frames without card or hand.
const EMPTY: [std::ops::Range<usize>; 3] = [0..260, 1540..1640, 2660..2932];

/// A choice that goes on, and how it does.
struct Choice {
    name: &'static str,
    tracker: Tracker,
    times_s: Vec<f64>,
    overlaps: Vec<f64>,
    empty_false: u32,
}

impl Choice {
    fn new(name: &'static str, config: Config, way: Running) -> Self {
        let tracker = Tracker::new(config, way);
        Self { name, tracker, times_s: Vec::new(), overlaps: Vec::new(), empty_false: 0 }
    }

    fn step(&mut self, frame: &Frame, grey: &Plane, outline: Option<&Mask>, is_empty: bool) {
        let start = Instant::now();
        let seen = self.tracker.step(frame, grey, &Mask::EMPTY, true);
        self.times_s.push(start.elapsed().as_secs_f64());
        self.empty_false += u32::from(is_empty && seen.is_some());
        if let Some(outline) = outline {
            self.overlaps.push(self.tracker.object().overlap(outline).into());
        }
    }

    /// Frames a second, by the median of their times.
    fn fps(&self) -> f64 {
        middle(self.times_s.iter().copied()).map_or(0.0, |median_s| 1.0 / median_s)
    }

    fn mean(&self) -> f64 {
        self.overlaps.iter().sum::<f64>() / self.overlaps.len().max(1) as f64
    }

    fn worst(&self) -> f64 {
        self.overlaps.iter().copied().fold(1.0, f64::min)
    }
}

/// Draws what the choices cost and bring on the video. All of them look at a frame one after the other, so that what else this machine
/// does slows all alike. Fails if the video cannot be read.
pub fn choices(video: &Path, progress: Progress) -> Result<Chart> {
    let usual = Config::default;
    let mut choices = [
        Choice::new("running mean (default)", usual(), Running::default()),
        Choice::new("mean of 2 frames", usual(), Running::new(14, 1)),
        Choice::new("mean of 8 frames", usual(), Running::new(14, 3)),
        Choice::new("8 grey levels", usual(), Running::new(8, 2)),
        Choice::new("24 grey levels", usual(), Running::new(24, 2)),
        Choice::new("colour from 15", Config { colour_min: 15, ..usual() }, Running::new(14, 2)),
        Choice::new("colour from 120", Config { colour_min: 120, ..usual() }, Running::new(14, 2)),
        Choice::new("hand not left out", Config { skip_hand: false, ..usual() }, Running::new(14, 2)),
    ];
    let outlines = outlines()?;
    let mut feed = Feed::open(&Source::Video(video.to_owned()), 54.0, None, false)?;
    let (mut grey, mut number, mut empty) = (plane(), 0, 0u32);
    while let Next::Picture(planes, ..) = feed.take()? {
        let frame = Frame::from_gbrp(&planes[..]).context("a picture's size")?;
        frame.grey(&mut grey);
        let is_empty = EMPTY.iter().any(|range| range.contains(&number));
        empty += u32::from(is_empty);
        // Who comes first finds a frame that is not in the cache yet: each in its turn.
        let first = number % choices.len();
        let (early, late) = choices.split_at_mut(first);
        for choice in late.iter_mut().chain(early) {
            choice.step(&frame, &grey, outlines.get(&number), is_empty);
        }
        number += 1;
        progress((number as f64 / EMPTY[2].end as f64).min(1.0));
    }
    let empty_share = |choice: &Choice| f64::from(choice.empty_false) / f64::from(empty.max(1));
    let rows = choices.iter().map(|choice| {
        let numbers = [choice.mean(), choice.worst(), empty_share(choice)].map(|value| format!("{value:.3}"));
        [choice.name.to_owned(), format!("{:.0}", choice.fps())].into_iter().chain(numbers).collect()
    });
    let csv = csv(&["choice", "object_fps", "overlap_mean", "overlap_worst", "empty_false_share"], rows)?;
    let fastest = choices.iter().map(Choice::fps).fold(0.0, f64::max);
    let panel = |title: &str, y: Axis, of: &dyn Fn(&Choice) -> f64| {
        let looks = COLOURS.into_iter().cycle().zip([Mark::Dots; 6].into_iter().chain([Mark::Rings; 6]));
        let series = choices.iter().zip(looks).map(|(choice, (colour, mark))| {
            Series::new(choice.name, colour, mark, [(choice.fps(), of(choice))])
        });
        Panel::new(title, Axis::even("frames a second on one core", 0.0, 1.1 * fastest), y, series.collect())
    };
    let sheet = Sheet::new(
        "Finding the object and its slip: speed against accuracy",
        "Real FingerVision video, 20 outlines by hand; seconds are this machine's",
        3,
        vec![
            panel("overlap, mean", Axis::even("intersection over union", 0.4, 0.9), &Choice::mean),
            panel("overlap, worst outline", Axis::even("intersection over union", 0.4, 0.9), &Choice::worst),
            panel("seen in the empty scene", Axis::even("share of frames", -0.002, 0.02), &empty_share),
        ],
    );
    Chart::new("vision-choices", &sheet, csv)
}

/// Colours of the choices, with dots and then with rings.
const COLOURS: [plotters::style::RGBColor; 6] =
    [colour::BLUE, colour::ORANGE, colour::GREEN, colour::PURPLE, colour::SKY, colour::VERMILLION];

/// Pixels inside the outlines, by frame.
fn outlines() -> Result<BTreeMap<usize, Mask>> {
    let parsed = OUTLINES.lines().filter(|line| !line.starts_with('#')).map(|line| {
        let fields = line.split(',').map(str::parse::<f32>).collect::<std::result::Result<Vec<_>, _>>()?;
        let corners: Vec<_> = fields[1..].chunks_exact(2).map(|corner| (corner[0], corner[1])).collect();
        Ok((fields[0] as usize, Mask::of_outline(&corners)))
    });
    parsed.collect()
}
