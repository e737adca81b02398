//! What a hand of several fingertips did, over many seeds: with a palm, and each fingertip alone.

use std::fmt;

use rayon::prelude::*;
use serde::Serialize;
use tenax_palm::palm::Report as Told;
use tenax_scene::SceneFile;
use tenax_serial::quantile::not_exceeded;

use super::{Options, Outcome, Part, run};

/// A scene's figures, with a palm and without.
#[derive(Clone, Debug, Serialize)]
pub struct Scene {
    pub name: String,
    pub runs: usize,
    /// Runs in which the object was kept.
    pub kept: usize,
    pub kept_alone: usize,
    /// How far it went, the skin's stretch included, mm: the mean, as the forces.
    pub slid_mm: f64,
    pub slid_alone_mm: f64,
    /// Pulses that nobody but the palm wished for, a run.
    pub wished: f64,
    /// The greatest sum of forces, N.
    pub pressed_n: f64,
    pub pressed_alone_n: f64,
    /// The greatest sum over the greatest that any instant needed, or that the wearer gripped with: by the friction that each finger
    /// knows of, and by the true one. The worst run of each.
    pub over_known: f64,
    pub over_known_alone: f64,
    pub over_true: f64,
    /// From a finger's slip to the evidence of all its neighbours, ms: median, 95th of a hundred, and how many; and those not told.
    pub evidence_ms: Option<[f64; 2]>,
    pub slips: usize,
    pub untold: u32,
    /// The same from where its own detectors said so: what the bus takes.
    pub bus_ms: Option<[f64; 2]>,
    pub clock_us: f64,
    pub cycle_us: u32,
    /// Messages of the fingers' lines, and those that did not come.
    pub messages: u64,
    pub missing: u64,
    /// Runs in which somebody else than the wearer opened, or somebody else than wearer and reflex drove.
    pub broken: usize,
}

/// What parts that break did.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Cuts {
    pub runs: usize,
    /// Dropped, though fingertips with the same part cut keep it without a palm.
    pub lost: usize,
    /// Dropped with and without.
    pub lost_alone: usize,
    /// Opened by somebody else than the wearer, or driven by somebody else than wearer and reflex.
    pub broken: usize,
    /// The longest until a lost finger or bus was reported, ms.
    pub told_ms: f64,
    /// Losses that nobody reported though the palm went on.
    pub untold: usize,
}

#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub scenes: Vec<Scene>,
    pub cuts: Option<Cuts>,
}

impl Report {
    /// Whether nothing that must never happen did.
    pub fn holds(&self) -> bool {
        let cuts = self.cuts.as_ref().is_none_or(|cuts| cuts.lost + cuts.broken + cuts.untold == 0);
        cuts && self
            .scenes
            .iter()
            .all(|scene| scene.broken == 0 && scene.kept >= scene.kept_alone && scene.missing == 0)
    }
}

/// Runs a scene with these seeds.
pub fn scene(file: &SceneFile, seeds: std::ops::Range<u64>) -> Scene {
    let runs: Vec<(Outcome, Outcome)> = seeds
        .into_par_iter()
        .map(|seed| {
            let of = |palm| run(file, &Options { seed, palm, ..Options::default() }, None);
            (of(true), of(false))
        })
        .collect();
    let mean =
        |value: &dyn Fn(&(Outcome, Outcome)) -> f64| runs.iter().map(value).sum::<f64>() / runs.len() as f64;
    let most = |value: &dyn Fn(&(Outcome, Outcome)) -> f64| runs.iter().map(value).fold(0.0, f64::max);
    let with = || runs.iter().map(|run| &run.0);
    let evidence: Vec<f64> = with().flat_map(|run| run.evidence_s.clone()).collect();
    Scene {
        name: file.name.clone(),
        runs: runs.len(),
        kept: with().filter(|run| !run.dropped).count(),
        kept_alone: runs.iter().filter(|run| !run.1.dropped).count(),
        slid_mm: mean(&|run| run.0.slid_mm),
        slid_alone_mm: mean(&|run| run.1.slid_mm),
        wished: mean(&|run| f64::from(run.0.wished)),
        pressed_n: mean(&|run| run.0.pressed_n()),
        pressed_alone_n: mean(&|run| run.1.pressed_n()),
        over_known: most(&|run| run.0.over(|sum| sum.known_n)),
        over_known_alone: most(&|run| run.1.over(|sum| sum.known_n)),
        over_true: most(&|run| run.0.over(|sum| sum.least_n)),
        slips: evidence.len(),
        evidence_ms: quantiles(&evidence),
        untold: with().map(|run| run.untold).sum(),
        bus_ms: quantiles(&with().flat_map(|run| run.said_s.clone()).collect::<Vec<_>>()),
        clock_us: most(&|run| run.0.clock_us),
        cycle_us: with().map(|run| run.cycle_us).max().unwrap_or(0),
        messages: with().flat_map(|run| &run.lines).map(|line| line.messages).sum(),
        missing: with()
            .map(|run| {
                let missing = run.lines.iter().map(|line| line.missed + line.bad_frames).sum::<u64>();
                missing + u64::from(run.line_dropped)
            })
            .sum(),
        broken: runs.iter().filter(|run| [&run.0, &run.1].iter().any(|run| run.opened || run.driven)).count(),
    }
}

/// Cuts something at a random instant, so many times.
pub fn cuts(files: &[SceneFile], count: u64) -> Cuts {
    let parts: Vec<Cuts> = (0..count)
        .into_par_iter()
        .map(|n| {
            let file = &files[n as usize % files.len()];
            let fingers = file.finger_count();
            // Golden-section steps: evenly over the scene, in another order.
            let at_s = 1.0 + (n as f64 * 0.618_034).fract() * (file.duration_s() - 1.5);
            let part = match n / files.len() as u64 % 4 {
                0 | 1 => Part::Finger(n as usize / 7 % fingers),
                2 => Part::Palm,
                _ if n % 2 == 0 => Part::Bus,
                _ => Part::Driver(n as usize / 7 % fingers),
            };
            let of = |palm| {
                run(
                    file,
                    &Options { seed: 100 + n, palm, cut: Some((at_s, part)), ..Options::default() },
                    None,
                )
            };
            let (with, alone) = (of(true), of(false));
            let told = with.reports.iter().find_map(|(told_s, report)| {
                let of_part = match (report, part) {
                    (Told::Lost(address), Part::Finger(finger)) => usize::from(*address) == finger + 1,
                    (Told::BusLost, Part::Bus | Part::Driver(_)) => true,
                    _ => false,
                };
                (of_part && *told_s >= at_s).then_some((told_s - at_s) * 1e3)
            });
            Cuts {
                runs: 1,
                lost: usize::from(with.dropped && !alone.dropped),
                lost_alone: usize::from(with.dropped && alone.dropped),
                broken: usize::from([&with, &alone].iter().any(|run| run.opened || run.driven)),
                told_ms: told.unwrap_or(0.0),
                untold: usize::from(part != Part::Palm && told.is_none()),
            }
        })
        .collect();
    parts.iter().fold(Cuts::default(), |all, one| Cuts {
        runs: all.runs + one.runs,
        lost: all.lost + one.lost,
        lost_alone: all.lost_alone + one.lost_alone,
        broken: all.broken + one.broken,
        told_ms: all.told_ms.max(one.told_ms),
        untold: all.untold + one.untold,
    })
}

/// Median and 95th of a hundred, ms.
fn quantiles(times_s: &[f64]) -> Option<[f64; 2]> {
    let at = |part| Some(not_exceeded(times_s.iter().copied(), part)? * 1e3);
    Some([at(0.5)?, at(0.95)?])
}

impl Outcome {
    /// The greatest sum of forces, N.
    fn pressed_n(&self) -> f64 {
        self.sums.iter().map(|sum| sum.pressed_n).fold(0.0, f64::max)
    }

    /// The greatest sum over what was needed until then, or what the wearer had gripped with: nothing but the wearer opens.
    fn over(&self, least: impl Fn(&super::Sum) -> Option<f64>) -> f64 {
        let Some(first) = self.sums.first() else { return 0.0 };
        let mut needed_n = first.pressed_n;
        let ratio = |sum: &super::Sum| {
            needed_n = least(sum).map_or(needed_n, |least_n| needed_n.max(least_n));
            sum.pressed_n / needed_n
        };
        self.sums.iter().map(ratio).fold(0.0, f64::max)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pair = |pair: Option<[f64; 2]>| {
            pair.map_or("none".into(), |[a, b]| format!("{a:.1} ms, 95 % within {b:.1} ms"))
        };
        for scene in &self.scenes {
            let Scene { name, runs, kept, kept_alone, .. } = scene;
            writeln!(f, "{name}")?;
            writeln!(
                f,
                "  object      kept in {kept} of {runs} runs, without a palm in {kept_alone}; went {:.2} mm, without {:.2} mm",
                scene.slid_mm, scene.slid_alone_mm
            )?;
            writeln!(
                f,
                "  force       all fingers {:.1} N, without a palm {:.1} N; over the least by known friction {:.2}, without {:.2}; by the true one {:.2}; {:.1} pulses by the palm",
                scene.pressed_n,
                scene.pressed_alone_n,
                scene.over_known,
                scene.over_known_alone,
                scene.over_true,
                scene.wished
            )?;
            writeln!(
                f,
                "  evidence    {} slips reached all neighbours, median {}; {} did not; of it the bus {}",
                scene.slips,
                pair(scene.evidence_ms),
                scene.untold,
                pair(scene.bus_ms)
            )?;
            writeln!(
                f,
                "  bus         cycle {} us at most, clocks within {:.0} us; {} messages, {} missing",
                scene.cycle_us, scene.clock_us, scene.messages, scene.missing
            )?;
            writeln!(f, "  never       opened or driven by anybody else: {} runs", scene.broken)?;
        }
        if let Some(cuts) = &self.cuts {
            let Cuts { runs, lost, lost_alone, broken, told_ms, untold } = cuts;
            writeln!(
                f,
                "cut at random\n  {runs} runs     {lost} dropped what the rest keeps without a palm, {lost_alone} dropped either way; {broken} opened or driven; loss told within {told_ms:.0} ms, {untold} untold"
            )?;
        }
        Ok(())
    }
}
