//! Checks of the numbers of a scene against each other.

use std::ops::Range;

use serde::Deserialize;
use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::channel::{CHANNELS, FSR, FSR_COUNT, Input, MYO_EXTENSOR, MYO_FLEXOR};
use toml::Spanned;
use toml::de::{DeTable, ValueDeserializer};

use super::SceneFile;
use super::quantity::Instant;
use super::sections::{Command, CommandKind, FaultKind, SensorFault};
use super::step::step;

pub(super) struct Wrong {
    pub(super) span: Range<usize>,
    pub(super) what: String,
}

pub(super) type Checked = Result<(), Wrong>;

pub(super) fn demand(fits: bool, span: Range<usize>, what: impl FnOnce() -> String) -> Checked {
    if fits { Ok(()) } else { Err(Wrong { span, what: what() }) }
}

pub(super) fn check(scene: &SceneFile, table: &DeTable<'_>) -> Checked {
    let instants = instants(table);
    friction(scene)?;
    end(scene, &instants)?;
    mass(scene)?;
    one_story(scene, &instants)?;
    step(scene)?;
    let opening = &scene.gripper.opening_mm;
    let (opening_mm, range_mm) = (opening.get_ref().get(), scene.gripper.range_mm.get());
    demand(opening_mm <= range_mm, opening.span(), || {
        format!("opening_mm = {opening_mm} is wider than range_mm = {range_mm}")
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
        let (mu_s, span, mu_d) = (mu_s.get(), mu_d.span(), mu_d.get_ref().get());
        demand(mu_d <= mu_s, span, || {
            format!(
                "mu_d = {mu_d} is greater than mu_s = {mu_s}; a contact cannot slide harder than it sticks"
            )
        })?;
    }
    Ok(())
}

/// Instants of the entries of all lists, each with its list's name and the one before which it may not be.
fn instants(table: &DeTable<'_>) -> Vec<(String, f64, Spanned<Instant>)> {
    let mut all = Vec::new();
    for (list, value) in table {
        for entry in value.get_ref().as_array().into_iter().flat_map(|entries| entries.iter()) {
            let mut after_s = 0.0;
            for instant in ["at_s", "until_s"].into_iter().filter_map(|key| entry.get_ref().get(key)) {
                let instant = Spanned::<Instant>::deserialize(ValueDeserializer::from(instant.clone()));
                let Ok(instant) = instant else { continue };
                let at_s = instant.get_ref().get();
                all.push((list.get_ref().to_string(), std::mem::replace(&mut after_s, at_s), instant));
            }
        }
    }
    all
}

fn end(scene: &SceneFile, instants: &[(String, f64, Spanned<Instant>)]) -> Checked {
    for (_, after_s, instant) in instants {
        let at_s = instant.get_ref().get();
        demand(at_s <= scene.duration_s(), instant.span(), || {
            format!("{at_s} s is after the scene's end at duration_s = {}", scene.duration_s())
        })?;
        demand(at_s >= *after_s, instant.span(), || format!("until_s = {at_s} is before at_s = {after_s}"))?;
    }
    Ok(())
}

fn mass(scene: &SceneFile) -> Checked {
    let mut poured_kg = scene.object.as_ref().map_or(0.0, |object| object.get_ref().mass_kg.get());
    for fill in &scene.fill {
        poured_kg += fill.add_kg.get_ref().get();
        demand(poured_kg > 0.0, fill.add_kg.span(), || {
            format!("add_kg leaves {poured_kg} kg of the object; it must stay above 0")
        })?;
    }
    Ok(())
}

fn one_story(scene: &SceneFile, instants: &[(String, f64, Spanned<Instant>)]) -> Checked {
    let wrong = |span, what: String| Err(Wrong { span, what });
    let (foreign, own): (&[&str], _) = match (&scene.object, &scene.robot) {
        (Some(_), Some(robot)) => {
            let what = "a scene has [object] (grasped) or [robot] (strokes a surface), not both";
            return wrong(robot.span(), what.to_owned());
        }
        (None, None) => {
            let what = "a scene needs [object] (something to grasp) or [robot] (strokes a surface)";
            return wrong(0..0, what.to_owned());
        }
        (Some(_), None) => (&["press", "sweep"], "[object]"),
        (None, Some(_)) => (&["fill", "move", "swing", "pull"], "[robot]"),
    };
    if let (None, Some(pitch)) = (&scene.object, &scene.pitch) {
        return wrong(pitch.span(), "[pitch] needs an [object]; this scene has a [robot]".to_owned());
    }
    match instants.iter().find(|(list, ..)| foreign.contains(&list.as_str())) {
        Some((list, _, instant)) => {
            wrong(instant.span(), format!("[[{list}]] is nothing for a scene with {own}"))
        }
        None => Ok(()),
    }
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
    let exchanges = [FaultKind::Swapped, FaultKind::Bridged].contains(&kind);
    if let Some(with) = &fault.with {
        demand(with.get_ref() != channel, with.span(), || "with is the channel itself".to_owned())?;
    }
    let own = [
        (kind == FaultKind::Pressed, fault.press_n.as_ref().map(Spanned::span), "pressed", "press_n"),
        (kind == FaultKind::Drift, fault.drift_per_s.as_ref().map(Spanned::span), "drift", "drift_per_s"),
        (exchanges, fault.with.as_ref().map(Spanned::span), "swapped\" or \"bridged", "with"),
    ];
    own.into_iter().try_for_each(|(is_it, key, kind, name)| match key {
        None => demand(!is_it, fault.channel.span(), || format!("kind = \"{kind}\" needs {name}")),
        Some(span) => demand(is_it, span, || format!("{name} belongs to kind = \"{kind}\" only")),
    })
}

fn command(command: &Command) -> Checked {
    let needs = |what: &str| Wrong { span: command.kind.span(), what: what.to_owned() };
    match *command.kind.get_ref() {
        CommandKind::Close | CommandKind::Open => {
            let duty = command
                .duty_permille
                .as_ref()
                .ok_or_else(|| needs("a drive needs duty_permille and for_s"))?;
            demand(*duty.get_ref() <= 1_000, duty.span(), || {
                format!("duty_permille = {} is outside 0..=1000", duty.get_ref())
            })?;
            command.for_s.map(|_| ()).ok_or_else(|| needs("a drive needs for_s"))
        }
        CommandKind::Begin(Behaviour::Turn { .. }) => {
            let value = command.value.as_ref().ok_or_else(|| needs("a turn needs value, in degrees"))?;
            demand((-180..=180).contains(value.get_ref()), value.span(), || {
                format!("value = {} degrees is outside -180..=180", value.get_ref())
            })
        }
        CommandKind::Begin(_) | CommandKind::End | CommandKind::Zero | CommandKind::Consent => Ok(()),
        CommandKind::Set(id) => {
            let value = command.value.as_ref().ok_or_else(|| needs("a setting needs value"))?;
            let (row, range) = (id.row(), id.row().range());
            demand(range.contains(value.get_ref()), value.span(), || {
                let (value, low, high) = (value.get_ref(), range.start(), range.end());
                format!("value = {value} {} is outside {low}..={high} of {}", row.unit, row.name)
            })
        }
    }
}
