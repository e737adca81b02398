//! The shares against an independent solver of linear programmes.

use microlp::{ComparisonOp, OptimizationDirection, Problem};
use proptest::prelude::*;
use tenax_palm::share::{Contact, load, share};

/// The least sum by the independent solver, mN, with bounds that are wider by this; None where nothing balances.
fn reference(contacts: &[Contact], pushed: [i64; 2], wider_mn: f64) -> Option<f64> {
    let mut problem = Problem::new(OptimizationDirection::Minimize);
    let forces: Vec<_> = contacts
        .iter()
        .map(|contact| {
            let bounds = (f64::from(contact.least_mn) - wider_mn, f64::from(contact.most_mn) + wider_mn);
            problem.add_var(1.0, bounds)
        })
        .collect();
    for (axis, pushed) in pushed.into_iter().enumerate() {
        let parts = forces
            .iter()
            .zip(contacts)
            .map(|(&force, contact)| (force, f64::from(contact.normal[axis]) / 1e3));
        let parts: Vec<_> = parts.filter(|(_, part)| *part != 0.0).collect();
        if !parts.is_empty() {
            problem.add_constraint(parts, ComparisonOp::Eq, pushed as f64 / 1e3);
        }
    }
    problem.solve().ok().map(|solution| solution.objective())
}

prop_compose! {
    fn contact()(degrees in 0..360, least_mn in 0..20_000, room_mn in 0..30_000) -> Contact {
        let normal = [f64::from(degrees).to_radians().cos(), f64::from(degrees).to_radians().sin()];
        Contact { normal: normal.map(|part| (part * 1e3).round() as i16), least_mn, most_mn: least_mn + room_mn }
    }
}

/// A hand, and forces that a load was made of: within the bounds, or not.
fn hand() -> impl Strategy<Value = (Vec<Contact>, Vec<i32>)> {
    (prop::collection::vec((contact(), 0..1_000_i32), 2..=5), any::<bool>(), -2_000..2_000_i32).prop_map(
        |(parts, opposed, beyond_mn)| {
            let line = parts[0].0.normal;
            let contacts = parts.iter().enumerate().map(|(n, (contact, _))| {
                // Half of the hands press along one line.
                let normal = if n % 2 == 0 { line } else { line.map(|part| -part) };
                if opposed { Contact { normal, ..*contact } } else { *contact }
            });
            let within = |contact: &Contact, part: i32| {
                contact.least_mn + (contact.most_mn - contact.least_mn) / 1_000 * part
            };
            let forces = parts
                .iter()
                .map(|(contact, part)| (within(contact, *part) + beyond_mn.min(0)).max(0))
                .collect();
            (contacts.collect(), forces)
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn no_forces_are_smaller_and_all_bounds_and_the_balance_are_kept((contacts, forces) in hand()) {
        let pushed = load(&contacts, &forces);
        let shared = share(&contacts, pushed);
        if reference(&contacts, pushed, 1.0).is_none() {
            prop_assert_eq!(shared, None);
        } else if let Some(least_mn) = reference(&contacts, pushed, 0.0) {
            let Some(shared) = shared else { return Err(TestCaseError::fail(format!("{least_mn} mN would do"))) };
            let sum = f64::from(shared.iter().sum::<i32>());
            prop_assert!(sum <= least_mn + 0.5 * contacts.len() as f64, "{sum} for {least_mn} mN: {shared:?}");
            prop_assert!(sum <= 1.15 * least_mn + 3.0);
            for (contact, mn) in contacts.iter().zip(&shared) {
                prop_assert!((contact.least_mn..=contact.most_mn).contains(mn));
            }
            // Half a millinewton of each of two free fingers.
            let rest = load(&contacts, &shared);
            prop_assert!(rest.iter().zip(pushed).all(|(rest, pushed)| (rest - pushed).abs() <= 1_000), "{rest:?}");
        }
    }
}
