//! Messages of a board, for people.

use tenax_hal_shim::channel::{CHANNELS, COUNT, FRAME_HZ, mv_from_sample};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{
    About, Answer, BadFrame, Down, EventKind, NetworkState, Refusal, Restored, SCHEMA, Setting, Slow,
    TickRecord, Up, VERSION,
};
use tenax_hal_shim::words::{Calibration, Fault, Line};
use tenax_logic::setting::SettingId;

/// End of a frame, s of the board's time.
pub fn seconds(frame: u32) -> f64 {
    (f64::from(frame) + 1.0) / f64::from(FRAME_HZ)
}

fn stamp(frame: u32) -> String {
    format!("{:10.4} s", seconds(frame))
}

pub fn names(set: DetectorSet) -> String {
    let names: Vec<&str> =
        DetectorId::ALL.iter().filter(|id| set.contains(**id)).map(|id| id.name()).collect();
    names.join(" ")
}

pub fn why(bad: BadFrame) -> String {
    match bad {
        BadFrame::Garbled => "garbled".to_owned(),
        BadFrame::Version(version) => format!(
            "of version {version}, and this tool speaks {VERSION}: flash the board anew, or use its own tool"
        ),
        BadFrame::TooLong => "longer than any message".to_owned(),
        BadFrame::Skipped => "no time for it".to_owned(),
    }
}

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
        Fault::RecordDamaged(kept) => {
            format!("the last {} to be saved are lost; older ones are used", kept.name())
        }
        Fault::StoreFull(kept) => {
            format!("no room to save {}: switch the hand off and on again", kept.name())
        }
        Fault::StoreFailed(kept) => format!("the flash did not take {}", kept.name()),
        Fault::WatchdogReset => "restarted by the watchdog".into(),
        Fault::PanicReset => "restarted after a panic".into(),
        Fault::SupplySagged => "restarted because the supply sagged".into(),
        Fault::CrystalLost => "the crystal is lost: timing is a per cent off".into(),
        Fault::TooManyRestarts => {
            "restarted too often: nothing moves before it is switched off and on".into()
        }
        Fault::NeverUnloaded => "the force sensor reads a load, and the hand is surely open".into(),
        Fault::BrownOutLevel => "the brown-out level is not 3: set it with a probe (docs/bring-up.md)".into(),
    }
}

/// What the line may do.
pub fn line_words(line: Line) -> String {
    match line {
        Line::Reading => "reads only".to_owned(),
        Line::Armed { left_s } => format!("may command for {left_s} s"),
        Line::Trusted => "trusted".to_owned(),
    }
}

pub fn identity_words(about: &About) -> String {
    let [c0, c1, c2] = about.identity.chip;
    match about.identity.build {
        0 => "the host's own build".to_owned(),
        build => format!("image {build:016x} on chip {c0:08x}{c1:08x}{c2:08x}"),
    }
}

pub fn answer_words(command: &Down, answer: &Answer) -> String {
    let said = match command {
        Down::Set(setting) => format!("set {}: ", setting_words(setting)),
        other => format!("{other:?}: "),
    };
    match answer {
        Answer::Done => said + "done",
        Answer::Refused(refusal) => said + "refused: " + &refusal_words(refusal),
        other => told(other, 0),
    }
}

pub fn refusal_words(refusal: &Refusal) -> String {
    let text = match refusal {
        Refusal::OutOfRange { min, max } => return format!("it has to be {min} to {max}"),
        Refusal::NotArmed => {
            "nobody at the hand has consented: contract both muscles for 2 s or press the blue button, then try again \
             within a minute"
        }
        Refusal::HeldTooLong => {
            "the line has silenced the reflex for too long; move a muscle, consent again, or wait as long"
        }
        Refusal::Loaded => "something presses on the finger, or is held",
        Refusal::SensorLost => "a sensor that it needs gives no number; `tenax monitor` says which",
        Refusal::Incomplete => "another setting of its transaction was refused or did not come: none is set",
        other => return format!("{other:?}"),
    };
    text.to_owned()
}

pub fn words(message: &Up) -> String {
    match message {
        Up::Hello { frame_hz, after } => {
            let after = after.as_ref().map_or_else(|| "switched on".to_owned(), in_words);
            format!("hello: {after}, {frame_hz} frames a second")
        }
        Up::Slow(slow) => slow_words(slow),
        Up::Event(event) => format!("{} {}", stamp(event.frame), event_words(event.kind)),
        Up::Counters(own) => format!("{own:?}"),
        Up::Answer { of, answer: Answer::Done, .. } => format!("done: command {of}"),
        Up::Answer { of, answer: Answer::Refused(refusal), .. } => {
            format!("refused: command {of}: {}", refusal_words(refusal))
        }
        Up::Answer { frame, answer, .. } => told(answer, *frame),
        Up::Saved { frame, kept } => format!("{} saved: {}", stamp(*frame), kept.name()),
        Up::About(about) => about_words(about),
        Up::Restored(Restored { kept, payload }) => {
            format!("taken up from flash: {}, {} bytes", kept.name(), payload.len())
        }
        Up::Raw(raw) => {
            let lost = raw.frames().iter().filter(|frame| !frame.valid).count();
            format!("{} {} frames, {lost} lost", stamp(raw.first), raw.frames().len())
        }
        Up::Senses(own) => format!("{} senses, mV:{}", stamp(own.frame), samples_words(&own.samples)),
        Up::Taken { before, of, command } => {
            format!("{} takes command {of}: {command:?}", stamp(before.wrapping_sub(1)))
        }
    }
}

fn told(answer: &Answer, frame: u32) -> String {
    match answer {
        Answer::Setting(own) => setting_words(own),
        Answer::Settings(all) => format!("settings:{}", setting_lines(all)),
        Answer::Samples(samples) => format!("{} samples, mV:{}", stamp(frame), samples_words(samples)),
        Answer::Network(network) => network_words(network),
        Answer::About(about) => about_words(about),
        Answer::Last(last) => match &last.after {
            None => "nothing is kept of a run before".to_owned(),
            Some(fault) => format!(
                "{} bytes are kept of the seconds before {} ({})",
                last.length,
                in_words(fault),
                String::from_utf8_lossy(&last.why)
            ),
        },
        Answer::Nonce(nonce) => format!("a session opens with {nonce:#010x}"),
        Answer::Done | Answer::Refused(_) => format!("{answer:?}"),
    }
}

fn about_words(about: &About) -> String {
    let ago_s = f64::from(about.frames) / f64::from(FRAME_HZ);
    let (identity, reset, board) = (identity_words(about), about.identity.reset, about.schema);
    let mut text = format!("about: {identity}, started because of {reset:?}, {ago_s:.1} s ago");
    if board != SCHEMA {
        text += &format!(
            "; its messages follow schema {board:016x}, this tool's {SCHEMA:016x}: built from other sources"
        );
    }
    text + &setting_lines(&about.settings)
}

fn setting_lines(all: &[Setting]) -> String {
    all.iter().map(|own| format!("\n      {}", setting_words(own))).collect()
}

fn setting_words(setting: &Setting) -> String {
    match SettingId::from_number(setting.id) {
        Some(id) => format!("{} = {} {}", id.row().name, setting.value, id.row().unit),
        None => format!("setting {} = {}, which this tool does not know", setting.id, setting.value),
    }
}

fn samples_words(samples: &[u16; COUNT]) -> String {
    let word = |(channel, &sample): (&tenax_hal_shim::channel::Channel, &u16)| {
        format!(" {}={}", channel.name, mv_from_sample(sample))
    };
    CHANNELS.iter().zip(samples).map(word).collect()
}

fn slow_words(slow: &Slow) -> String {
    let forces = slow.forces.map_or_else(
        || "no force".to_owned(),
        |forces| {
            let [normal, shear] = [forces.fn_mn, forces.ft_mn].map(|mn| f64::from(mn) / 1e3);
            let ratio = f64::from(forces.ratio_permille.unwrap_or(0)) / 1e3;
            format!("Fn {normal:6.2} N Ft {shear:6.2} N Ft/Fn {ratio:5.3}")
        },
    );
    let muscle = |mv: Option<i16>| mv.map_or_else(|| "lost".to_owned(), |mv| format!("{mv:5} mV"));
    let vibration = slow.ticks.iter().map(|tick| tick.vibration).max().unwrap_or(0);
    let mut text = format!(
        "{} {:<9} {forces} vibration {:4} mV flexor {} extensor {}",
        stamp(slow.frame),
        format!("{:?}", slow.mode),
        mv_from_sample(vibration),
        muscle(slow.flexor_mv),
        muscle(slow.extensor_mv)
    );
    match slow.ticks.last().map(|tick| tick.drive) {
        Some(MotorDrive::Close(duty)) => text += &format!(" closing {}", duty.as_per_mille()),
        Some(MotorDrive::Open(duty)) => text += &format!(" opening {}", duty.as_per_mille()),
        Some(MotorDrive::Coast) | None => {}
    }
    type Set = fn(&TickRecord) -> DetectorSet;
    let sets: [(&str, Set); 3] =
        [("said", |tick| tick.said), ("believed", |tick| tick.believed), ("acted", |tick| tick.acted)];
    for (word, set) in sets {
        let ever = slow.ticks.iter().fold(DetectorSet::NONE, |ever, tick| ever.or(set(tick)));
        if ever != DetectorSet::NONE {
            text += &format!(" {word}: {}", names(ever));
        }
    }
    text += if slow.lesson.is_some() { " learning" } else { "" };
    text += if slow.wearer_active { " wearer" } else { "" };
    text + " line " + &line_words(slow.line)
}

fn network_words(network: &NetworkState) -> String {
    let NetworkState { updates, no_lesson, teacher_age_ms, .. } = network;
    let weights = network.weights.map(|all| all.map(|own| f64::from(own) / f64::from(1 << 27)));
    let activations = network.activations.map(|own| f64::from(own) / f64::from(1 << 14));
    format!(
        "{} network: {updates} updates, no lesson: {no_lesson:?}, age of the teacher's picture, ms: {teacher_age_ms:?}\n      \
         w: {weights:.3?}\n      t: {activations:.3?}",
        stamp(network.frame)
    )
}

fn event_words(kind: EventKind) -> String {
    match kind {
        EventKind::Mode { from, to, cause } => format!("mode: {from} -> {to}: {cause}"),
        EventKind::Fault(fault) => format!("fault: {}", in_words(&fault)),
        EventKind::Stroke { mu_s_permille, s2_permille } => {
            let [mu_s, s2] = [mu_s_permille, s2_permille].map(|permille| f64::from(permille) / 1e3);
            format!("stroke: mu_s {mu_s:.3}, S2 is now {s2:.3}")
        }
        EventKind::Pulse { margin_mn, said, believed } => {
            let margin = margin_mn.map_or_else(|| "unknown".to_owned(), |mn| format!("{mn} mN"));
            format!("pulse: margin {margin}, said: {}, believed: {}", names(said), names(believed))
        }
        EventKind::Motor(Some(stop)) => format!("motor: stopped, {}", stop.name()),
        EventKind::Behaviour(what, ending) => {
            let ending = ending.map_or("begins", |ending| ending.name());
            format!("behaviour: {}: {ending}", what.name())
        }
        EventKind::Calibration(Calibration::Asks(prompt)) => {
            format!("calibration: {}, for 5 s from now", prompt.name())
        }
        EventKind::Calibration(Calibration::Refused(why)) => {
            format!("calibration: refused, {why}; the one before is still in force")
        }
        EventKind::Calibration(Calibration::Fit(fit)) => format!("calibration: {}", fit.name()),
        other => format!("{other:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_of_another_schema_is_named_and_one_of_ours_is_not() {
        let words = |schema| words(&Up::About(About { schema, ..About::default() }));
        assert!(!words(SCHEMA).contains("schema"));
        assert!(words(7).contains("schema 0000000000000007, this tool's"), "{}", words(7));
    }
}
