//! Groups of bars measured on all cores, printed in their order.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

use anyhow::Result;

/// Something to measure: what it is called while it runs, and how.
pub struct Group<'a, T> {
    /// Shown while it runs.
    pub name: String,
    pub measure: Box<dyn Fn() -> Result<T> + Sync + 'a>,
}

impl<'a, T> Group<'a, T> {
    pub fn new(name: impl Into<String>, measure: impl Fn() -> Result<T> + Sync + 'a) -> Self {
        Self { name: name.into(), measure: Box::new(measure) }
    }
}

/// Measures all groups. `running` hears the names of those that run, `each` the results in the groups' order.
/// Fails with the first in the groups' order; what comes after it is not told.
pub fn measure<T: Send>(
    groups: &[Group<'_, T>],
    mut running: impl FnMut(String),
    mut each: impl FnMut(T),
) -> Result<()> {
    let next = AtomicUsize::new(0);
    let workers = std::thread::available_parallelism().map_or(1, NonZero::get).min(groups.len());
    std::thread::scope(|scope| {
        let (sender, results) = mpsc::channel();
        for _ in 0..workers {
            let (sender, next) = (sender.clone(), &next);
            scope.spawn(move || {
                while let Some((n, group)) = take(groups, next) {
                    // Nobody listens any more if an earlier group has failed.
                    if sender.send((n, None)).is_err() || sender.send((n, Some((group.measure)()))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let (mut waiting, mut told, mut names) = (BTreeMap::new(), 0, BTreeMap::new());
        for (n, result) in results {
            match result {
                None => {
                    names.insert(n, groups[n].name.as_str());
                }
                Some(result) => {
                    names.remove(&n);
                    waiting.insert(n, result);
                }
            }
            running(names.values().copied().collect::<Vec<_>>().join(" | "));
            while let Some(result) = waiting.remove(&told) {
                each(result?);
                told += 1;
            }
        }
        Ok(())
    })
}

fn take<'a, 'b, T>(groups: &'a [Group<'b, T>], next: &AtomicUsize) -> Option<(usize, &'a Group<'b, T>)> {
    let n = next.fetch_add(1, Ordering::Relaxed);
    Some((n, groups.get(n)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn results_come_in_the_groups_order() {
        let group = |n: u64| {
            Group::new(n.to_string(), move || {
                std::thread::sleep(Duration::from_millis(20 - 2 * n));
                Ok(n)
            })
        };
        let groups: Vec<_> = (0..10).map(group).collect();
        let mut told = Vec::new();
        measure(&groups, |_| (), |n| told.push(n)).unwrap();
        assert_eq!(told, (0..10).collect::<Vec<_>>());
    }

    #[test]
    fn an_error_ends_it() {
        let group = |n: u64| Group::new("", move || if n == 2 { anyhow::bail!("no") } else { Ok(n) });
        let groups: Vec<_> = (0..4).map(group).collect();
        let mut told = Vec::new();
        assert!(measure(&groups, |_| (), |n| told.push(n)).is_err());
        assert_eq!(told, [0, 1]);
    }
}
