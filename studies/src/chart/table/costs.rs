//! What each row takes of the core and its memories, counted on the emulated Cortex-M4.

use std::collections::BTreeMap;

/// Of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Decisions a second that the rest is of.
    pub per_s: u32,
    pub instructions_mean: f64,
    pub instructions_max: u64,
    /// Least, likely, most.
    pub cycles: Option<[f64; 3]>,
    pub flash_bytes: Option<u64>,
    pub ram_bytes: Option<u64>,
}

/// Of a kernel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kernel {
    /// How often it runs.
    pub per_s: f64,
    pub mean: f64,
    pub max: u64,
    /// Least, likely, most.
    pub cycles: Option<[f64; 3]>,
    /// Functions, each with its bytes: kernels may share some.
    pub code: BTreeMap<String, u64>,
    pub constants: u64,
    pub state: u64,
}

/// Every kernel's, by name. Empty where there is no core to count on.
#[derive(Clone, Debug, Default)]
pub struct Costs(pub BTreeMap<String, Kernel>);

impl Costs {
    /// Of these kernels together, for each of so many decisions a second; the worst is all of them at their worst. None if one of them
    /// was not counted.
    pub fn of(&self, kernels: &[&str], per_s: u32) -> Option<Cost> {
        let own: Vec<&Kernel> = kernels.iter().map(|name| self.0.get(*name)).collect::<Option<_>>()?;
        let share = |kernel: &Kernel| kernel.per_s / f64::from(per_s);
        let code: BTreeMap<&String, u64> =
            own.iter().flat_map(|kernel| kernel.code.iter().map(|(name, &bytes)| (name, bytes))).collect();
        Some(Cost {
            per_s,
            instructions_mean: own.iter().map(|kernel| kernel.mean * share(kernel)).sum(),
            instructions_max: own
                .iter()
                .map(|kernel| kernel.max * share(kernel).round().max(1.0) as u64)
                .sum(),
            cycles: own.iter().try_fold([0.0; 3], |sum, kernel| {
                let more = kernel.cycles?.map(|cycles| cycles * share(kernel));
                Some(std::array::from_fn(|n| sum[n] + more[n]))
            }),
            flash_bytes: Some(
                code.values().sum::<u64>() + own.iter().map(|kernel| kernel.constants).sum::<u64>(),
            ),
            ram_bytes: Some(own.iter().map(|kernel| kernel.state).sum()),
        })
    }

    /// Counts them: the kernels on a recording of the table's own kind, the whole tick in the default scene. Builds both images first.
    /// Fails if one cannot be built or does not run.
    #[cfg(feature = "emulator")]
    pub fn counted(root: &std::path::Path) -> anyhow::Result<Self> {
        use anyhow::Context;
        use tenax_bench::board::emulated::Options;
        use tenax_bench::board::emulated::kernels::{self, Kernels};
        use tenax_bench::image::{self, kernels::memories, size::Size};
        use tenax_bench::live::Use;
        use tenax_bench::session::{self, Board};
        use tenax_hal_shim::channel::{FRAME_HZ, SLOW_HZ};

        let frames = super::heard::sampled(FRAMES)?;
        let readings = super::heard::readings(&frames);
        let elf = image::build_frames(root)?;
        let cycles = kernels::cycles::cycles(&elf, &readings, &frames)?;
        let outcome = kernels::run_frames(&elf, &[readings], &frames, Kernels::Detector, &mut |_| {})?;
        let memories = memories(&elf)?;
        let mut all = BTreeMap::new();
        for cost in outcome.costs {
            let memory = memories.get(cost.name.as_str()).cloned().unwrap_or_default();
            let seconds = frames.len() as f64 / f64::from(FRAME_HZ);
            let cycles = cycles.get(&cost.name).copied();
            // The array's detector is given a reading for each slow frame.
            let per_s =
                if cost.name == "slow_frame" { f64::from(SLOW_HZ) } else { cost.calls as f64 / seconds };
            let (code, constants, state) = (memory.code, memory.constants, memory.state);
            let kernel = Kernel { per_s, mean: cost.mean(), max: cost.most, cycles, code, constants, state };
            all.insert(cost.name, kernel);
        }
        let options = Options { followed_from: Some(FOLLOWED_FROM), ..Options::default() };
        let board = Board::Emulated { image: image::build(root)?, options };
        let file = session::load_scene(session::DEFAULT_SCENE)?;
        let run = session::scene_alone(&file, 1, &board, Use::default(), &mut ())?.run;
        let tick = run.tick_cost.context("the emulated board counts its ticks")?;
        let size = Size::read(&image::build(root)?)?;
        let tick = Kernel {
            per_s: f64::from(FRAME_HZ),
            mean: tick.instructions_mean,
            max: tick.instructions_max,
            cycles: run.tick_cycles,
            code: BTreeMap::from([("the image".to_owned(), size.flash)]),
            constants: 0,
            state: size.ram,
        };
        all.insert("tick".to_owned(), tick);
        Ok(Self(all))
    }

    /// None: there is no core to count on.
    #[cfg(not(feature = "emulator"))]
    pub fn counted(_root: &std::path::Path) -> anyhow::Result<Self> {
        Ok(Self::default())
    }
}

/// The glass is filled at 20 s: ticks that hold something are followed.
#[cfg(feature = "emulator")]
const FOLLOWED_FROM: u64 = 40_000;
/// Frames that the kernels are counted on: 5 s.
#[cfg(feature = "emulator")]
const FRAMES: usize = 10_000;
