//! Messages of a board, for people.

use std::fmt::{self, Display};

use tenax_hal_shim::channel::{CHANNELS, COUNT, FRAME_HZ, mv_from_sample};
use tenax_hal_shim::detector::{DetectorHealth, DetectorId, DetectorSet};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{
    About, Answer, BadFrame, Down, Event, EventKind, Identity, Last, NetworkState, Raw, Refusal, Restored,
    SCHEMA, Setting, Slow, TickRecord, Up, VERSION,
};
use tenax_hal_shim::words::{Calibration, Fault, Kept, Line};
use tenax_logic::setting::SettingId;

/// The names of detectors, one blank between them.
pub fn names(set: DetectorSet) -> String {
    let names: Vec<&str> =
        DetectorId::ALL.iter().filter(|id| set.contains(**id)).map(|id| id.name()).collect();
    names.join(" ")
}

/// Why a frame is no message.
pub fn why(bad: BadFrame) -> String {
    match bad {
        BadFrame::Garbled => "garbled".to_owned(),
        BadFrame::Version(version) => {
            format!(
                "of version {version}, and this tool speaks {VERSION}: flash the board anew, or use its own tool"
            )
        }
        BadFrame::TooLong => "longer than any message".to_owned(),
        BadFrame::Skipped => "no time for it".to_owned(),
    }
}

/// A fault for a person.
pub fn in_words(fault: &Fault) -> String {
    let name =
        |channel: u8| CHANNELS.get(usize::from(channel)).map_or("unknown channel", |channel| channel.name);
    match *fault {
        Fault::SensorLost { channel, reason } => format!("{} gives no number: {reason:?}", name(channel)),
        Fault::SensorBack { channel } => format!("{} gives numbers again", name(channel)),
        Fault::CapabilityLost(capability) => format!("lost: {capability:?}"),
        Fault::CapabilityBack(capability) => format!("back: {capability:?}"),
        Fault::FramesLost { count } => format!("{count} frames lost"),
        Fault::PressedAtBoot { channel } => format!("{} was loaded when the board started", name(channel)),
        Fault::WatchdogReset => "restarted by the watchdog".to_owned(),
        Fault::PanicReset => "restarted after a panic".to_owned(),
        Fault::SupplySagged => "restarted because the supply sagged".to_owned(),
        Fault::CrystalLost => "the crystal is lost: timing is a per cent off".to_owned(),
        Fault::TooManyRestarts => {
            "restarted too often: nothing moves before it is switched off and on".to_owned()
        }
        Fault::NeverUnloaded => "the force sensor reads a load, and the hand is surely open".to_owned(),
        Fault::RecordDamaged(kept) => {
            format!("the last {} to be saved are lost; older ones are used", kept_in_words(kept))
        }
        Fault::StoreFull(kept) => {
            format!("no room to save {}: switch the hand off and on again", kept_in_words(kept))
        }
        Fault::StoreFailed(kept) => format!("the flash did not take {}", kept_in_words(kept)),
    }
}

/// What is kept, for a person.
pub const fn kept_in_words(kept: Kept) -> &'static str {
    match kept {
        Kept::Network => "the network's weights",
        Kept::Zero => "the force sensor's zeros",
        Kept::Settings => "the settings",
        Kept::Emg => "the wearer's calibration",
    }
}

/// Which image runs on which chip.
pub struct AboutWords<'a>(pub &'a About);

impl Display for AboutWords<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Identity { build, chip: [c0, c1, c2], .. } = self.0.identity;
        match build {
            0 => write!(f, "the host's own build"),
            _ => write!(f, "image {build:016x} on chip {c0:08x}{c1:08x}{c2:08x}"),
        }
    }
}

/// What the board answers to a command, for the person who gave it.
pub struct AnswerWords<'a>(pub &'a Down, pub &'a Answer);

impl Display for AnswerWords<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(command, answer) = self;
        match (command, answer) {
            (Down::Set(Setting { id, value }), Answer::Done | Answer::Refused(_)) => {
                match SettingId::from_number(*id) {
                    Some(id) => write!(f, "set {} = {value}: ", id.row().name)?,
                    None => write!(f, "set {id} = {value}: ")?,
                }
            }
            (_, Answer::Done | Answer::Refused(_)) => write!(f, "{command:?}: ")?,
            _ => {}
        }
        let up = Up::Answer { of: 0, frame: 0, answer: (*answer).clone() };
        write!(f, "{}", Words(&up).to_string().replace(": command 0", "").replace(" command 0", ""))
    }
}

/// A message, for a person.
pub struct Words<'a>(pub &'a Up);

impl Display for Words<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Up::Hello { frame_hz, after: None } => {
                write!(f, "hello: switched on, {frame_hz} frames a second")
            }
            Up::Hello { frame_hz, after: Some(fault) } => {
                write!(f, "hello: {}, {frame_hz} frames a second", in_words(fault))
            }
            Up::Slow(slow) => slow_words(f, slow),
            Up::Event(event) => event_words(f, event),
            Up::Counters(counters) => write!(
                f,
                "counters: {} frames, {} lost, {} overruns; {} ticks, {} late; {} messages dropped, {} bad frames heard, {} commands skipped; a frame took \
                 control {} us at worst, {:.1} % of the time now",
                counters.frames,
                counters.frames_lost,
                counters.overruns,
                counters.ticks,
                counters.ticks_late,
                counters.telemetry_dropped,
                counters.bad_frames,
                counters.commands_skipped,
                counters.control_us_max,
                f64::from(counters.control_permille) / 10.0
            ),
            Up::Answer { of, frame, answer } => answer_words(f, *of, *frame, answer),
            Up::Saved { frame, kept } => {
                write!(f, "{:10.4} s saved: {}", seconds(*frame), kept_in_words(*kept))
            }
            Up::About(about) => about_words(f, about),
            Up::Restored(Restored { kept, payload }) => {
                write!(f, "taken up from flash: {}, {} bytes", kept_in_words(*kept), payload.len())
            }
            Up::Raw(raw) => raw_words(f, raw),
            Up::Senses(senses) => {
                write!(f, "{:10.4} s senses, mV:", seconds(senses.frame))?;
                samples_words(f, &senses.samples)
            }
            Up::Taken { before, of, command } => {
                write!(f, "{:10.4} s takes command {of}: {command:?}", seconds(before.wrapping_sub(1)))
            }
        }
    }
}

fn answer_words(f: &mut fmt::Formatter<'_>, of: u16, frame: u32, answer: &Answer) -> fmt::Result {
    match answer {
        Answer::Done => write!(f, "done: command {of}"),
        Answer::Refused(Refusal::OutOfRange { min, max }) => {
            write!(f, "refused: command {of}: outside {min}..={max}")
        }
        Answer::Refused(Refusal::NotArmed) => write!(
            f,
            "refused: command {of}: nobody at the hand has consented: contract both muscles for 2 s or press the blue \
             button, then send it again within a minute"
        ),
        Answer::Refused(Refusal::HeldTooLong) => write!(
            f,
            "refused: command {of}: the line has silenced the reflex for too long; move a muscle, consent again, or wait as long"
        ),
        Answer::Refused(refusal) => write!(f, "refused: command {of}: {refusal:?}"),
        Answer::Setting(own) => setting_words(f, own),
        Answer::Settings(all) => {
            write!(f, "settings:")?;
            all.iter().try_for_each(|own| {
                write!(f, "\n      ")?;
                setting_words(f, own)
            })
        }
        Answer::Samples(samples) => {
            write!(f, "{:10.4} s samples, mV:", seconds(frame))?;
            samples_words(f, samples)
        }
        Answer::Network(network) => network_words(f, network),
        Answer::About(about) => about_words(f, about),
        Answer::Last(last) => last_words(f, last),
        Answer::Nonce(nonce) => write!(f, "a session opens with {nonce:#010x}"),
    }
}

fn last_words(f: &mut fmt::Formatter<'_>, last: &Last) -> fmt::Result {
    match &last.after {
        None => f.write_str("nothing is kept of a run before"),
        Some(fault) => write!(
            f,
            "{} bytes are kept of the seconds before {} ({}): `tenax record --last` fetches them",
            last.length,
            in_words(fault),
            String::from_utf8_lossy(&last.why)
        ),
    }
}

fn about_words(f: &mut fmt::Formatter<'_>, about: &About) -> fmt::Result {
    let ago_s = f64::from(about.frames) / f64::from(FRAME_HZ);
    write!(
        f,
        "about: {}, started because of {:?}, {ago_s:.1} s ago",
        AboutWords(about),
        about.identity.reset
    )?;
    if about.schema != SCHEMA {
        let (own, board) = (SCHEMA, about.schema);
        write!(
            f,
            "; its messages follow schema {board:016x}, this tool's {own:016x}: built from other sources"
        )?;
    }
    for setting in &about.settings {
        write!(f, "\n      ")?;
        setting_words(f, setting)?;
    }
    Ok(())
}

fn raw_words(f: &mut fmt::Formatter<'_>, raw: &Raw) -> fmt::Result {
    for (n, frame) in raw.frames().iter().enumerate() {
        if n > 0 {
            write!(f, "\n      ")?;
        }
        write!(f, "{:10.4} s frame", seconds(frame.sequence))?;
        match frame.valid {
            true => write!(f, " {:?} {} {}", frame.pvdf, frame.switch_a, frame.switch_b)?,
            false => write!(f, " lost")?,
        }
    }
    Ok(())
}

fn samples_words(f: &mut fmt::Formatter<'_>, samples: &[u16; COUNT]) -> fmt::Result {
    CHANNELS
        .iter()
        .zip(samples)
        .try_for_each(|(channel, &sample)| write!(f, " {}={}", channel.name, mv_from_sample(sample)))
}

fn setting_words(f: &mut fmt::Formatter<'_>, setting: &Setting) -> fmt::Result {
    match SettingId::from_number(setting.id) {
        Some(id) => write!(f, "{} = {} {}", id.row().name, setting.value, id.row().unit),
        None => write!(f, "setting {} = {}, which this tool does not know", setting.id, setting.value),
    }
}

/// When a frame ended, s of the board's time.
pub fn seconds(frame: u32) -> f64 {
    (f64::from(frame) + 1.0) / f64::from(FRAME_HZ)
}

fn slow_words(f: &mut fmt::Formatter<'_>, slow: &Slow) -> fmt::Result {
    write!(f, "{:10.4} s {:<9}", seconds(slow.frame), format!("{:?}", slow.mode))?;
    match slow.forces {
        Some(forces) => {
            write!(
                f,
                " Fn {:6.2} N Ft {:6.2} N",
                f64::from(forces.fn_mn) / 1e3,
                f64::from(forces.ft_mn) / 1e3
            )?;
            match forces.ratio_permille {
                Some(ratio) => write!(f, " Ft/Fn {:5.3}", f64::from(ratio) / 1e3)?,
                None => write!(f, " Ft/Fn     -")?,
            }
        }
        None => write!(f, " no force")?,
    }
    let vibration = slow.ticks.iter().map(|tick| tick.vibration).max().unwrap_or(0);
    write!(f, " vibration {:4} mV", mv_from_sample(vibration))?;
    for (name, mv) in [("flexor", slow.flexor_mv), ("extensor", slow.extensor_mv)] {
        match mv {
            Some(mv) => write!(f, " {name} {mv:5} mV")?,
            None => write!(f, " {name} lost")?,
        }
    }
    let last = slow.ticks.last();
    if let Some([o1, o2]) =
        last.map(|tick| tick.outputs.map(|o| f64::from(o) / 128.0)).filter(|o| *o != [0.0; 2])
    {
        write!(f, " o {o1:5.2} {o2:5.2}")?;
    }
    if slow.lesson.is_some() {
        f.write_str(" learning")?;
    }
    let mlp = slow
        .evidence
        .iter()
        .find(|(id, own)| *id == DetectorId::Mlp && own.health == DetectorHealth::Working);
    if let Some((_, mlp)) = mlp {
        write!(f, " p(slip) {:5.3}", f64::from(mlp.confidence_permille) / 1e3)?;
    }
    match last.map(|tick| tick.drive) {
        Some(MotorDrive::Close(duty)) => write!(f, " closing {}", duty.as_per_mille())?,
        Some(MotorDrive::Open(duty)) => write!(f, " opening {}", duty.as_per_mille())?,
        Some(MotorDrive::Coast) | None => {}
    }
    // Said, and what became of it.
    let ever = |set: fn(&TickRecord) -> DetectorSet| {
        slow.ticks.iter().fold(DetectorSet::NONE, |ever, tick| ever.or(set(tick)))
    };
    let (said, believed, acted) =
        (ever(|tick| tick.said), ever(|tick| tick.believed), ever(|tick| tick.acted));
    for id in DetectorId::ALL.into_iter().filter(|id| said.contains(*id)) {
        let fate = match (acted.contains(id), believed.contains(id)) {
            (true, _) => "!",
            (false, true) => "",
            (false, false) => " ignored",
        };
        write!(f, " {}{fate}", id.name())?;
    }
    f.write_str(if slow.wearer_active { " wearer" } else { "" })?;
    match slow.line {
        Line::Reading => Ok(()),
        Line::Armed { left_s } => write!(f, " armed {left_s} s"),
        Line::Trusted => f.write_str(" line trusted"),
    }
}

fn network_words(f: &mut fmt::Formatter<'_>, network: &NetworkState) -> fmt::Result {
    write!(f, "{:10.4} s network: {} updates", seconds(network.frame), network.updates)?;
    match (network.no_lesson, network.teacher_age_ms) {
        (None, _) => f.write_str(", learning")?,
        (Some(why), Some(age_ms)) => {
            write!(f, ", no lesson: {why:?}, the teacher's picture is {age_ms} ms old")?
        }
        (Some(why), None) => write!(f, ", no lesson: {why:?}")?,
    }
    for (output, weights) in network.weights.iter().enumerate() {
        write!(f, "\n      w{}:", output + 1)?;
        for &weight in weights {
            write!(f, " {:6.3}", f64::from(weight) / f64::from(1 << 27))?;
        }
    }
    write!(f, "\n       t:")?;
    for &activation in &network.activations {
        write!(f, " {:6.3}", f64::from(activation) / f64::from(1 << 14))?;
    }
    Ok(())
}

fn event_words(f: &mut fmt::Formatter<'_>, event: &Event) -> fmt::Result {
    write!(f, "{:10.4} s ", seconds(event.frame))?;
    match event.kind {
        EventKind::Mode { from, to, cause } => write!(f, "mode: {from} -> {to}: {cause}"),
        EventKind::Fault(fault) => write!(f, "fault: {}", in_words(&fault)),
        EventKind::Stroke { mu_s_permille, s2_permille } => write!(
            f,
            "stroke: mu_s {:.3}, S2 is now {:.3}",
            f64::from(mu_s_permille) / 1e3,
            f64::from(s2_permille) / 1e3
        ),
        EventKind::Armed(by) => write!(f, "armed: {by:?} consented to what the line sends"),
        EventKind::Disarmed => f.write_str("disarmed: the line is only read"),
        EventKind::LineTrusted(true) => f.write_str("the line is trusted: it moves the hand without consent"),
        EventKind::NoWearer(true) => f.write_str("no wearer: the reflex works without myosensors"),
        EventKind::NoWearer(false) => f.write_str("a wearer: the reflex works with both myosensors only"),
        EventKind::LineTrusted(false) => f.write_str("the line is trusted no more"),
        EventKind::EventsLost(count) => write!(f, "{count} events lost"),
        EventKind::Motor(Some(stop)) => write!(f, "motor: stopped, {}", stop.name()),
        EventKind::Motor(None) => f.write_str("motor: free again"),
        EventKind::Pulse { margin_mn, said, believed } => {
            f.write_str("pulse: margin ")?;
            match margin_mn {
                Some(mn) => write!(f, "{:.2} N", f64::from(mn) / 1e3)?,
                None => f.write_str("unknown")?,
            }
            let doubted = said.without(believed);
            write!(f, ", believed: {}", names(believed))?;
            if doubted.is_empty() { Ok(()) } else { write!(f, ", not believed: {}", names(doubted)) }
        }
        EventKind::Behaviour(what, None) => write!(f, "behaviour: {} begins", what.name()),
        EventKind::Behaviour(what, Some(ending)) => {
            write!(f, "behaviour: {} ended, {}", what.name(), ending.name())
        }
        EventKind::Calibration(Calibration::Asks(prompt)) => {
            write!(f, "calibration: {}, for 5 s from now", prompt.name())
        }
        EventKind::Calibration(Calibration::Done { separation_permille }) => {
            write!(
                f,
                "calibration: done, the states are {:.1} deviations apart",
                f64::from(separation_permille) / 1e3
            )
        }
        EventKind::Calibration(Calibration::Refused(refusal)) => {
            write!(f, "calibration: refused, {refusal}; what was in force before still is")
        }
        EventKind::Calibration(Calibration::Fit(fit)) => write!(f, "calibration: {}", fit.name()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_of_another_schema_is_named_and_one_of_ours_is_not() {
        let words = |schema| Words(&Up::About(About { schema, ..About::default() })).to_string();
        assert!(!words(SCHEMA).contains("schema"));
        assert!(words(7).contains("schema 0000000000000007, this tool's"), "{}", words(7));
    }
}
