//! Both myosensors: their health, the wearer's wish, and the calibration to a wearer.

use tenax_hal_shim::channel::{CHANNELS, MYO_EXTENSOR, MYO_FLEXOR, SLOW_HZ, frames};
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{self, Fault, Fit, Prompt, Reason};

use crate::emg::calibration::{Calibration, Progress};
use crate::emg::decide::Wish;
use crate::emg::fit::Watch;
use crate::emg::mains::mains_of;
use crate::emg::model::EmgModel;
use crate::emg::trust::Quality;
use crate::emg::{Emg, Verdict, uv_of_sample};
use crate::health::{Limits, SensorHealth};
use crate::journal::Journal;

const MISSES: u8 = 3;
const HZ: u32 = 3 * SLOW_HZ;
const FROZEN_AFTER: u32 = HZ / 20;
static LIMITS: Limits = Limits { lost_after: HZ / 20 + 1, ..Limits::of(&CHANNELS[MYO_FLEXOR], HZ) };

#[derive(Clone, Debug)]
struct Lesson {
    calibration: Calibration,
    asked: Option<Prompt>,
}

#[derive(Clone, Debug, Default)]
pub struct Muscles {
    emg: Emg,
    health: [SensorHealth; 2],
    missed: [u8; 2],
    /// No active muscle by its last sample: below range, below activity, or constant.
    idle: [bool; 2],
    /// Two active readings in a row that differ: a glitch or a frozen sensor is not a wish.
    confirmed: [bool; 2],
    lost: [Option<Reason>; 2],
    /// Wish that was refused because its electrode proved nothing.
    refused: Wish,
    uv: [Option<i32>; 2],
    model: Option<EmgModel>,
    watch: Watch,
    lesson: Option<Lesson>,
    ended: Option<(u32, bool)>,
}

/// Light: a calibration's result; on and off of a refusal; of the prompt to open; period and flash of rest.
const RESULT_FRAMES: u32 = frames(2_000);
const REFUSED_FRAMES: u32 = frames(50);
const OPEN_FRAMES: u32 = frames(100);
const REST_FRAMES: [u32; 2] = [frames(1_000), frames(100)];
const ASK_FRAMES: u32 = frames(4_000);

impl Muscles {
    /// 14-bit sample of muscle 0 (flexor) or another (extensor). Gives the envelope above the live zero, uV.
    pub fn take(&mut self, muscle: usize, sample: u16, journal: &mut Journal) -> Option<i32> {
        let n = muscle.min(1);
        self.missed[n] = 0;
        let was_raised = self.emg.is_raised(n);
        let (reading, _) = if was_raised {
            self.health[n].take(&Limits { stuck_after: FROZEN_AFTER, ..LIMITS }, sample)
        } else {
            self.health[n].take(&LIMITS, sample)
        };
        let is_low = sample < LIMITS.low;
        self.idle[n] = is_low || sample <= LIMITS.high && self.emg.is_idle(n, uv_of_sample(sample));
        let uv = reading.ok().map(uv_of_sample);
        // Above its range there is no number, but a motion that has begun goes on.
        self.read(n, uv.or_else(|| (sample > LIMITS.high).then(|| uv_of_sample(sample))), journal);
        let differs = self.health[n].same == 0;
        self.confirmed[n] = self.emg.is_raised(n) && (self.confirmed[n] || (was_raised && differs));
        uv
    }

    /// The last reading counts once more, since readings measure time. True if too many frames were lost.
    pub fn miss(&mut self, muscle: usize, journal: &mut Journal) -> bool {
        let n = muscle.min(1);
        self.missed[n] = self.missed[n].saturating_add(1);
        let gone = self.missed[n] >= MISSES;
        if gone {
            (self.confirmed[n], self.idle[n]) = (false, false);
        }
        self.read(n, self.uv[n].filter(|_| !gone), journal);
        gone
    }

    fn read(&mut self, muscle: usize, uv: Option<i32>, journal: &mut Journal) {
        let n = muscle.min(1);
        self.emg.read(n, uv);
        self.uv[n] = uv;
        if n == 1 && self.lesson.is_some() {
            self.learn(journal);
        }
        let opens = self.model.as_ref().map_or(1, EmgModel::opening_site);
        let refused = self.refused == if n == opens { Wish::Open } else { Wish::Close };
        let lost = self.health[n]
            .lost
            .or_else(|| reason_of(self.emg.quality(n)))
            .or(refused.then_some(Reason::NoContact));
        if lost != self.lost[n] {
            self.tell(n, lost, journal);
        }
    }

    /// The electrode of a wish that is refused is reported as one without contact.
    pub const fn refuse(&mut self, wish: Wish) {
        self.refused = wish;
    }

    #[inline(never)]
    fn tell(&mut self, muscle: usize, lost: Option<Reason>, journal: &mut Journal) {
        let n = muscle.min(1);
        let channel = (if n == 0 { MYO_FLEXOR } else { MYO_EXTENSOR }) as u8;
        match (self.lost[n], lost) {
            (None, Some(reason)) | (Some(Reason::Flat | Reason::Stuck), Some(reason @ Reason::Hum)) => {
                journal.fault(Fault::SensorLost { channel, reason });
            }
            (Some(_), None) => journal.fault(Fault::SensorBack { channel }),
            _ => return,
        }
        self.lost[n] = lost;
    }

    /// During a calibration the wish is rest, and no other source may move the hand.
    pub fn verdict(&self) -> Verdict {
        let mut verdict = self.emg.verdict();
        let [flexor, extensor] = [0, 1].map(|n: usize| self.emg.is_known(n));
        verdict.half_known = verdict.known || flexor && self.idle[1] || extensor && self.idle[0];
        let at_rest = Verdict {
            active: true,
            known: verdict.known,
            half_known: verdict.half_known,
            ..Verdict::default()
        };
        let opens = self.model.as_ref().map_or(1, EmgModel::opening_site);
        match verdict.wish {
            _ if self.lesson.is_some() => at_rest,
            Wish::Open if !self.confirmed[opens] => at_rest,
            Wish::Close if !self.confirmed[1 - opens] => at_rest,
            _ => verdict,
        }
    }

    pub fn is_heard(&self) -> bool {
        self.emg.is_active(0) || self.emg.is_active(1)
    }

    pub const fn model(&self) -> Option<&EmgModel> {
        self.model.as_ref()
    }

    pub fn calibrate(&mut self, model: EmgModel) {
        self.emg.calibrate(Some(&model));
        self.model = Some(model);
        self.watch = Watch::default();
    }

    /// The caller refuses it while something is held. `by_button`: a short one while moved electrodes are reported.
    pub fn begin_calibration(&mut self, frame: u32, by_button: bool) {
        let kept = self.model.as_ref().filter(|_| by_button && self.watch.fit() == Fit::Moved);
        let calibration =
            kept.map_or_else(|| Calibration::begin(frame), |kept| Calibration::short(frame, kept));
        self.lesson = Some(Lesson { calibration, asked: None });
    }

    pub const fn is_calibrating(&self) -> bool {
        self.lesson.is_some()
    }

    /// Prompts: a short flash a second for rest, steady for closing, five flashes a second for opening. For 2
    /// s after: steady if taken, ten flashes a second if refused. Later, every 4 s: two short flashes if the
    /// calibration fits no more, three if the electrodes look exchanged.
    pub fn light(&self, frame: u32) -> bool {
        if let Some(lesson) = &self.lesson {
            return match lesson.asked {
                None | Some(Prompt::Rest) => frame % REST_FRAMES[0] < REST_FRAMES[1],
                Some(Prompt::Close) => true,
                Some(Prompt::Open) => frame % (2 * OPEN_FRAMES) < OPEN_FRAMES,
            };
        }
        let shown = |since: u32, taken| taken || since % (2 * REFUSED_FRAMES) < REFUSED_FRAMES;
        match self.ended {
            Some((at, taken)) if frame.wrapping_sub(at) < RESULT_FRAMES => {
                shown(frame.wrapping_sub(at), taken)
            }
            _ => {
                let flashes = match self.watch.fit() {
                    Fit::Fits => 0,
                    Fit::Moved => 2,
                    Fit::Exchanged => 3,
                };
                let place = frame % ASK_FRAMES;
                place < flashes * 2 * OPEN_FRAMES && place % (2 * OPEN_FRAMES) < OPEN_FRAMES
            }
        }
    }

    #[inline(never)]
    pub fn give_up(&mut self, why: words::CalibrationRefusal, journal: &mut Journal) {
        if self.lesson.take().is_some() {
            let _nothing_new = self.conclude(Err(why), journal);
        }
    }

    #[inline(never)]
    fn learn(&mut self, journal: &mut Journal) {
        let frame = journal.frame();
        let Some(lesson) = &mut self.lesson else { return };
        if lesson.calibration.is_over(frame) {
            return;
        }
        if let Progress::Asks(prompt, _) = lesson.calibration.take(frame, self.uv)
            && lesson.asked != Some(prompt)
        {
            lesson.asked = Some(prompt);
            journal.event(EventKind::Calibration(words::Calibration::Asks(prompt)));
        }
    }

    /// A spectrum of one electrode, or the end of a calibration; true if there is a new one. Once a slow frame.
    #[inline(never)]
    pub fn think(&mut self, journal: &mut Journal) -> bool {
        if let Some(lesson) = &mut self.lesson {
            let frame = journal.frame();
            if lesson.calibration.is_over(frame) {
                if let Progress::Done(result) = lesson.calibration.take(frame, [None; 2]) {
                    self.lesson = None;
                    return self.conclude(result, journal);
                }
                // A step is asked for again.
                lesson.asked = None;
            }
            return false;
        }
        let fit = self.watch.fit();
        if let Some(model) = &self.model
            && self.watch.take(model, self.emg.levels(), self.emg.verdict())
            && self.watch.fit() != fit
        {
            journal.event(EventKind::Calibration(words::Calibration::Fit(self.watch.fit())));
        }
        for n in 0..2 {
            if let Some(window) = self.emg.window(n) {
                let mains = mains_of(window);
                self.emg.hear(n, mains);
                break;
            }
        }
        false
    }

    pub fn has_window(&self) -> bool {
        self.lesson.is_none() && (0..2).any(|n| self.emg.window(n).is_some())
    }

    fn conclude(
        &mut self,
        result: Result<EmgModel, words::CalibrationRefusal>,
        journal: &mut Journal,
    ) -> bool {
        let told = match result {
            Ok(model) => words::Calibration::Done { separation_permille: model.separation_permille() },
            Err(refusal) => words::Calibration::Refused(refusal),
        };
        journal.event(EventKind::Calibration(told));
        self.ended = Some((journal.frame(), result.is_ok()));
        if let Ok(model) = result {
            self.calibrate(model);
        }
        result.is_ok()
    }
}

const fn reason_of(quality: Quality) -> Option<Reason> {
    match quality {
        Quality::Good => None,
        Quality::LeadOff => Some(Reason::NoContact),
        Quality::Hum => Some(Reason::Hum),
        Quality::Creep => Some(Reason::Creep),
        Quality::Flat => Some(Reason::Flat),
        Quality::Endless => Some(Reason::Endless),
        Quality::Saturated => Some(Reason::Saturated),
    }
}
