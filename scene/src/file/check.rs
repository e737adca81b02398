//! Checks of the numbers of a scene against each other.

use std::ops::Range;

use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::channel::{CHANNELS, FSR, FSR_COUNT, Input, MYO_EXTENSOR, MYO_FLEXOR};
use toml::Spanned;

use super::SceneFile;
use super::quantity::{Instant, Mu};
use super::sections::{Command, CommandKind, FaultKind, Level, SensorFault};
use super::step::step;

pub(super) struct Wrong {
    pub(super) span: Range<usize>,
    pub(super) what: String,
}

pub(super) type Checked = Result<(), Wrong>;

pub(super) fn demand(fits: bool, span: Range<usize>, what: impl FnOnce() -> String) -> Checked {
    if fits { Ok(()) } else { Err(Wrong { span, what: what() }) }
}

pub(super) fn check(scene: &SceneFile) -> Checked {
    friction(scene)?;
    level(scene)?;
    instants(scene)?;
    one_story(scene)?;
    step(scene)?;
    let opening = &scene.gripper.opening_mm;
    demand(opening.get_ref().get() <= scene.gripper.range_mm.get(), opening.span(), || {
        format!(
            "opening_mm = {} is wider than range_mm = {}",
            opening.get_ref().get(),
            scene.gripper.range_mm.get()
        )
    })?;
    for lift in &scene.electrode_lift {
        let channel = lift.channel.get_ref();
        demand([MYO_FLEXOR, MYO_EXTENSOR].contains(&channel.index()), lift.channel.span(), || {
            format!("channel = \"{}\" has no electrode; allowed: myo_flexor, myo_extensor", channel.name())
        })?;
    }
    scene.fault.iter().try_for_each(fault)?;
    scene.command.iter().try_for_each(command)
}

fn friction(scene: &SceneFile) -> Checked {
    let pairs = scene.wet.iter().map(|wet| (wet.mu_s, &wet.mu_d));
    for (mu_s, mu_d) in pairs.chain([(scene.contact.mu_s, &scene.contact.mu_d)]) {
        let mu_d_value = Mu::get(*mu_d.get_ref());
        demand(mu_d_value <= mu_s.get(), mu_d.span(), || {
            format!(
                "mu_d = {mu_d_value} is greater than mu_s = {}; a contact cannot slide harder than it sticks",
                mu_s.get()
            )
        })?;
    }
    Ok(())
}

fn level(scene: &SceneFile) -> Checked {
    let contact = &scene.contact;
    let skin = contact.skin_n_per_mm.as_ref().map(|skin| ("skin_n_per_mm", skin.span()));
    let skin_ms = contact.skin_ms.as_ref().map(|skin| ("skin_ms", skin.span()));
    let stribeck = contact.stribeck_mm_s.as_ref().map(|speed| ("stribeck_mm_s", speed.span()));
    for (key, level, needs) in
        [(skin, Level::L1, "l1"), (skin_ms, Level::L1, "l1"), (stribeck, Level::L2, "l2")]
    {
        if let Some((key, span)) = key.filter(|_| contact.level != level) {
            let what = format!("{key} belongs to level = \"{needs}\" and would change nothing here");
            return Err(Wrong { span, what });
        }
    }
    if let Some(rise) = contact.mu_per_decade.as_ref().filter(|_| contact.level == Level::L2) {
        let what =
            "mu_per_decade belongs to level = \"l0\" or \"l1\"; with l2 friction falls with speed".to_owned();
        return Err(Wrong { span: rise.span(), what });
    }
    Ok(())
}

fn instants(scene: &SceneFile) -> Checked {
    let mut all: Vec<&Spanned<Instant>> = Vec::new();
    all.extend(scene.wet.iter().flat_map(|wet| [Some(&wet.at_s), wet.until_s.as_ref()]).flatten());
    all.extend(scene.fill.iter().map(|fill| &fill.at_s));
    all.extend(scene.moves.iter().map(|step| &step.at_s));
    all.extend(scene.swing.iter().map(|swing| &swing.at_s));
    all.extend(scene.pull.iter().map(|pull| &pull.at_s));
    all.extend(scene.press.iter().map(|press| &press.at_s));
    all.extend(scene.sweep.iter().map(|sweep| &sweep.at_s));
    all.extend(scene.knock.iter().map(|knock| &knock.at_s));
    all.extend(scene.hum.iter().map(|hum| &hum.at_s));
    all.extend(scene.muscle.iter().map(|muscle| &muscle.at_s));
    all.extend(scene.electrode_lift.iter().map(|lift| &lift.at_s));
    all.extend(scene.jam.iter().map(|jam| &jam.at_s));
    all.extend(scene.fault.iter().flat_map(|fault| [Some(&fault.at_s), fault.until_s.as_ref()]).flatten());
    all.extend(scene.command.iter().map(|command| &command.at_s));
    for instant in all {
        let at_s = instant.get_ref().get();
        demand(at_s <= scene.duration_s(), instant.span(), || {
            format!("{at_s} s is after the scene's end at duration_s = {}", scene.duration_s())
        })?;
    }
    let mut poured_kg = scene.object.as_ref().map_or(0.0, |object| object.get_ref().mass_kg.get());
    for fill in &scene.fill {
        poured_kg += fill.add_kg.get_ref().get();
        demand(poured_kg > 0.0, fill.add_kg.span(), || {
            format!("add_kg leaves {poured_kg} kg of the object; it must stay above 0")
        })?;
    }
    Ok(())
}

fn one_story(scene: &SceneFile) -> Checked {
    match (&scene.object, &scene.robot) {
        (Some(_), Some(robot)) => Err(Wrong {
            span: robot.span(),
            what: "a scene has [object] (grasped) or [robot] (strokes a surface), not both".to_owned(),
        }),
        (None, None) => Err(Wrong {
            span: 0..0,
            what: "a scene needs [object] (something to grasp) or [robot] (strokes a surface)".to_owned(),
        }),
        (Some(_), None) => {
            let press = scene.press.iter().map(|press| &press.at_s);
            let foreign = press.chain(scene.sweep.iter().map(|sweep| &sweep.at_s));
            refuse(foreign, "[[press]] and [[sweep]] are the robot's; this scene has an [object]")
        }
        (None, Some(_)) => {
            if let Some(pitch) = &scene.pitch {
                let what = "[pitch] needs an [object]; this scene has a [robot]".to_owned();
                return Err(Wrong { span: pitch.span(), what });
            }
            let what =
                "[[fill]], [[move]], [[swing]] and [[pull]] need an [object]; this scene has a [robot]";
            let fill_move =
                scene.fill.iter().map(|fill| &fill.at_s).chain(scene.moves.iter().map(|go| &go.at_s));
            let swing_pull =
                scene.swing.iter().map(|swing| &swing.at_s).chain(scene.pull.iter().map(|pull| &pull.at_s));
            refuse(fill_move.chain(swing_pull), what)
        }
    }
}

fn refuse<'a>(mut foreign: impl Iterator<Item = &'a Spanned<Instant>>, what: &str) -> Checked {
    foreign.next().map_or(Ok(()), |instant| Err(Wrong { span: instant.span(), what: what.to_owned() }))
}

fn fault(fault: &SensorFault) -> Checked {
    let channel = fault.channel.get_ref();
    let kind = fault.kind;
    demand(
        kind != FaultKind::Pressed || (FSR..FSR + FSR_COUNT).contains(&channel.index()),
        fault.channel.span(),
        || format!("channel = \"{}\" cannot be pressed; allowed: fsr_a to fsr_d", channel.name()),
    )?;
    let is_switched = !matches!(CHANNELS[channel.index()].input, Input::Direct { .. });
    demand(kind != FaultKind::Open || is_switched, fault.channel.span(), || {
        format!("channel = \"{}\" is behind no switch", channel.name())
    })?;
    let press = fault.press_n.as_ref().map(Spanned::span);
    only(kind == FaultKind::Pressed, press, fault, "pressed", "press_n")?;
    let drift = fault.drift_per_s.as_ref().map(Spanned::span);
    only(kind == FaultKind::Drift, drift, fault, "drift", "drift_per_s")?;
    let with = fault.with.as_ref().map(Spanned::span);
    only(
        [FaultKind::Swapped, FaultKind::Bridged].contains(&kind),
        with,
        fault,
        "swapped\" or \"bridged",
        "with",
    )
}

fn only(is_it: bool, key: Option<Range<usize>>, fault: &SensorFault, kind: &str, name: &str) -> Checked {
    match key {
        None => demand(!is_it, fault.channel.span(), || format!("kind = \"{kind}\" needs {name}")),
        Some(span) if !is_it => {
            Err(Wrong { span, what: format!("{name} belongs to kind = \"{kind}\" only") })
        }
        Some(_) => Ok(()),
    }
}

fn command(command: &Command) -> Checked {
    let kind = *command.kind.get_ref();
    let wrong = |span, what: String| Err(Wrong { span, what });
    match kind {
        CommandKind::Close | CommandKind::Open => {
            let Some(duty) = &command.duty_permille else {
                return wrong(command.kind.span(), "a drive needs duty_permille and for_s".to_owned());
            };
            demand(*duty.get_ref() <= 1_000, duty.span(), || {
                format!("duty_permille = {} is outside 0..=1000", duty.get_ref())
            })?;
            demand(command.for_s.is_some(), command.kind.span(), || "a drive needs for_s".to_owned())
        }
        CommandKind::Begin(Behaviour::Turn { .. }) => {
            let Some(value) = &command.value else {
                return wrong(command.kind.span(), "a turn needs value, in degrees".to_owned());
            };
            demand((-180..=180).contains(value.get_ref()), value.span(), || {
                format!("value = {} degrees is outside -180..=180", value.get_ref())
            })
        }
        CommandKind::Begin(_) | CommandKind::End | CommandKind::Zero | CommandKind::Consent => Ok(()),
        CommandKind::Set(id) => {
            let Some(value) = &command.value else {
                return wrong(command.kind.span(), "a setting needs value".to_owned());
            };
            let row = id.row();
            let range = row.range();
            demand(range.contains(value.get_ref()), value.span(), || {
                format!(
                    "value = {} {} is outside {}..={} of {}",
                    value.get_ref(),
                    row.unit,
                    range.start(),
                    range.end(),
                    row.name
                )
            })
        }
    }
}
