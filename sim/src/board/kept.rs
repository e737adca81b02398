//! Records that a board holds before the start: whether its line is trusted, other settings, and the calibration to the wearer of what
//! is played.

use anyhow::Context;
use tenax_frames::settings::named;
use tenax_hal_shim::flash::{BLANK, FlashArea, FlashFailed, Sector};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::words::Kept;
use tenax_logic::config::Config;
use tenax_logic::device::Device;
use tenax_logic::emg::model::EmgModel;
use tenax_logic::setting::SettingId;
use tenax_logic::store::{Erase, open, payload};
use tenax_scene::plant::{Calibrated, Pins, Plant};

pub const STORE: u64 = 0x0804_0000;
pub const SECTOR_WORDS: usize = 128 * 1024 / 4;

/// The model of a wearer. Fails if there can be no such wearer.
pub fn model_of(calibrated: &Calibrated) -> anyhow::Result<EmgModel> {
    let uv = |mv: [u16; 2]| mv.map(|mv| i32::from(mv) * 1_000);
    match *calibrated {
        Calibrated::Levels { rest_mv, close_mv, open_mv } => {
            EmgModel::of_uv(uv(rest_mv), uv(close_mv), uv(open_mv))
        }
        Calibrated::Words(words) => EmgModel::from_words(words),
    }
    .map_err(|refusal| anyhow::anyhow!("{refusal}"))
    .context("the wearer's calibration")
}

/// Settings by name. Fails if one is none or out of its range.
pub fn config_of(settings: &[(String, i32)]) -> anyhow::Result<Config> {
    let mut config = Config::default();
    for (name, value) in settings {
        let range = |range: std::ops::RangeInclusive<i32>| {
            anyhow::anyhow!("{name} = {value}: it may be {} to {}", range.start(), range.end())
        };
        config.set(named(name)?, *value).map_err(range)?;
    }
    Ok(config)
}

/// A plant at a board whose flash holds settings.
pub struct Set<P> {
    pub plant: P,
    settings: Option<Vec<u8>>,
}

impl<P: Plant> Set<P> {
    pub fn new(plant: P, settings: &[(String, i32)]) -> anyhow::Result<Self> {
        let mut config = config_of(settings)?;
        config.line_trusted |= plant.trusts_line();
        let settings = (!settings.is_empty()).then(|| payload::of_settings(&config).to_vec());
        Ok(Self { plant, settings })
    }
}

impl<P: Plant> Plant for Set<P> {
    tenax_scene::put_around!(plant);

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.plant.scan(drive)
    }

    fn kept(&self) -> Vec<(Kept, Vec<u8>)> {
        let own = self.settings.iter().map(|payload| (Kept::Settings, payload.clone()));
        own.chain(self.plant.kept()).collect()
    }
}

#[derive(Clone, Debug, Default)]
pub struct Provision {
    pub trusts_line: bool,
    pub streams_at_start: bool,
    pub calibrated: Option<EmgModel>,
    pub kept: Vec<(Kept, Vec<u8>)>,
}

impl Provision {
    /// What a plant's board was set up with. Fails if there can be no such wearer.
    pub fn of(plant: &dyn Plant) -> anyhow::Result<Self> {
        Ok(Self {
            trusts_line: plant.trusts_line(),
            streams_at_start: plant.streams_at_start(),
            calibrated: plant.calibrated().as_ref().map(model_of).transpose()?,
            kept: plant.kept(),
        })
    }

    pub fn records(&self) -> Vec<(Kept, Vec<u8>)> {
        let mut config = Config::default();
        // Both are in every range.
        let _accepted = config.set(SettingId::LineTrusted, self.trusts_line.into());
        let _accepted = config.set(SettingId::StreamAtStart, self.streams_at_start.into());
        let settings = payload::of_settings(&config);
        let settings = (!settings.is_empty()).then(|| (Kept::Settings, settings.to_vec()));
        let emg = self.calibrated.as_ref().map(|model| (Kept::Emg, payload::of_emg(model).to_vec()));
        let since = |kept: &Kept| self.kept.iter().any(|(own, _)| own == kept);
        let before = settings.into_iter().chain(emg).filter(|(kept, _)| !since(kept));
        before.chain(self.kept.iter().cloned()).collect()
    }

    pub fn device(&self) -> Device {
        let mut device = Device::default();
        for (kept, payload) in self.records() {
            device.restore(kept, &payload);
        }
        device
    }
}

#[derive(Clone, Debug)]
pub struct Sectors(pub Vec<u32>);

impl Sectors {
    pub fn blank() -> Self {
        Self(vec![BLANK; 2 * SECTOR_WORDS])
    }

    pub fn saving(mut self, kept: Kept, payload: &[u8]) -> Self {
        let (mut log, _) = open(&mut self, Erase::Allowed);
        let mut saving = log.begin(kept, payload).expect("room");
        while !saving.step(&mut self).expect("a flash that works") {}
        self
    }

    pub fn image(&self) -> (u64, Vec<u8>) {
        (STORE, self.0.iter().flat_map(|word| word.to_le_bytes()).collect())
    }

    pub fn provisioned(provision: &Provision) -> Self {
        let save = |sectors: Self, (kept, payload): &(Kept, Vec<u8>)| sectors.saving(*kept, payload);
        provision.records().iter().fold(Self::blank(), save)
    }
}

impl FlashArea for Sectors {
    fn sector_words(&self) -> usize {
        SECTOR_WORDS
    }

    fn read(&self, sector: Sector, word: usize) -> u32 {
        self.0[sector as usize * SECTOR_WORDS + word]
    }

    fn program(&mut self, sector: Sector, word: usize, value: u32) -> Result<(), FlashFailed> {
        self.0[sector as usize * SECTOR_WORDS + word] &= value;
        Ok(())
    }

    fn erase(&mut self, sector: Sector) -> Result<(), FlashFailed> {
        self.0[sector as usize * SECTOR_WORDS..][..SECTOR_WORDS].fill(BLANK);
        Ok(())
    }
}
