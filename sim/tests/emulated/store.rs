//! What the image keeps through resets and power cuts, and that keeping it costs no frame.

use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Answer, Down, Event, EventKind, Setting};
use tenax_hal_shim::words::{Fault, Kept};
use tenax_logic::config::Config;
use tenax_logic::setting::SettingId;
use tenax_logic::store::payload;
use tenax_sim::board::emulated::{Mishap, Options};
use tenax_sim::board::kept::Sectors;

use crate::{Run, Swing, agrees, run};

fn at_start(sectors: &Sectors) -> Options {
    Options { flash: Some(sectors.image()), ..Options::default() }
}

fn s2(permille: u16) -> Down {
    Down::Set(Setting { id: SettingId::S2.number(), value: permille.into() })
}

fn settings(s2_permille: u16) -> payload::SettingsBytes {
    let mut config = Config::default();
    assert!(config.set(SettingId::LineTrusted, 1).is_ok());
    assert!(config.set(SettingId::S2, s2_permille.into()).is_ok());
    payload::of_settings(&config)
}

fn s2_at_end(run: &Run) -> Option<u16> {
    run.slows.last().map(|slow| slow.s2_permille)
}

fn faults(run: &Run) -> Vec<Fault> {
    let of_store = |event: &Event| match event.kind {
        EventKind::Fault(fault @ (Fault::RecordDamaged(_) | Fault::StoreFull(_) | Fault::StoreFailed(_))) => {
            Some(fault)
        }
        _ => None,
    };
    run.events.iter().filter_map(of_store).collect()
}

fn kept(run: &Run) -> Vec<Kept> {
    run.saved.iter().map(|&(_, kept)| kept).collect()
}

/// One at each place; `TENAX_CUTS=30` is the bar, and `host-tests/tests/store/cuts.rs` draws a thousand.
// Shows B4.
#[test]
fn power_cuts_while_saving_leave_each_time_the_setting_before() {
    let cuts: u16 = std::env::var("TENAX_CUTS").map_or(7, |count| count.parse().expect("a number"));
    let ends_s = 0.3 * f64::from(cuts + 1);
    let (mut plant, mut mishaps) = (Swing::new(ends_s + 0.3).at_rest(), Vec::new());
    for n in 0..=cuts {
        let at_s = 0.2 + 0.3 * f64::from(n);
        plant = plant.sending(at_s, s2(300 + 5 * n)).sending(at_s + 0.25, Down::Get(SettingId::S2.number()));
        // In a mark, a tag, a number, two settings, a checksum or a commit; the last has power for long enough.
        mishaps.push((at_s - 0.05, Mishap::PowerFails(if n < cuts { u32::from(n % 7) } else { 40 })));
    }
    mishaps.push((ends_s, Mishap::ResetByPin));
    let start = at_start(&Sectors::blank().saving(Kept::Settings, &settings(295)));
    let run = run(plant, &Options { mishaps, ..start });
    assert_eq!(run.starts, vec![None; usize::from(cuts) + 2]);
    let answers = run.answers.iter().filter(|(of, _)| of % 2 == 1).map(|(_, answer)| answer);
    let value = |permille| Answer::Setting(Setting { id: SettingId::S2.number(), value: permille });
    let mut expected = vec![value(295); cuts.into()];
    expected.push(value((300 + 5 * cuts).into()));
    assert!(answers.eq(&expected), "{:?}", run.answers);
    assert_eq!((s2_at_end(&run), kept(&run)), (Some(300 + 5 * cuts), vec![Kept::Settings]));
    // Half a tag does not even say what it was to be; from the third cut on, each start finds what is left.
    assert_eq!(faults(&run), vec![Fault::RecordDamaged(Kept::Settings); usize::from(cuts) - 2]);
    assert!(run.drives.iter().all(|drive| *drive == MotorDrive::Coast));
}

// Shows B7.
#[test]
fn sampling_loses_nothing_while_the_network_is_saved_whatever_the_line_carries() {
    let plant = || Swing::new(1.0).sending(0.3, Down::Save);
    let slow_flash = |plant| run(plant, &Options { word_us: 100, ..Options::default() });
    let stream = Down::Stream { raw: true, senses: true, hold_s: 10 };
    let [plain, streaming] = [plant(), plant().sending(0.2, stream)].map(slow_flash);
    assert_eq!(
        plain.flash.words, 80,
        "a mark and a record; the sector was opened for the setting that trusts the line"
    );
    assert_eq!((plain.counters.telemetry_dropped, plain.messages_missed), (0, 0));
    for run in [plain, streaming] {
        let counters = run.counters;
        assert_eq!(kept(&run), [Kept::Network]);
        assert_eq!((counters.overruns, counters.frames_lost, counters.ticks_late), (0, 0, 0), "{counters:?}");
        agrees("slow flash", &run);
    }
    // The control: the core does stand still meanwhile. A flash twenty times as slow as any costs frames.
    let hopeless = run(plant(), &Options { word_us: 2_000, ..Options::default() });
    assert!(hopeless.counters.frames_lost > 0, "{:?}", hopeless.counters);
}

// Shows B6.
#[test]
fn a_boot_with_a_half_full_sector_erases_the_other_and_goes_on() {
    let mut sectors = Sectors::blank().saving(Kept::Settings, &settings(450));
    for n in 0..208u8 {
        sectors = sectors.saving(Kept::Network, &[n; 296]);
    }
    let plant = Swing::new(1.0).sending(0.3, s2(470)).at_rest();
    let options = Options { mishaps: vec![(0.6, Mishap::CoreHangs)], ..at_start(&sectors) };
    let run = run(plant, &options);
    assert_eq!(run.flash.erases, 1);
    assert_eq!(run.starts, [None, Some(Fault::WatchdogReset)]);
    assert_eq!(run.slows[0].s2_permille, 450, "copied");
    assert_eq!(s2_at_end(&run), Some(470), "appended behind the copy");
    assert!(run.drives.iter().all(|drive| *drive == MotorDrive::Coast));
    // The weights were nonsense; the hand says so and works without.
    assert_eq!(faults(&run), [Fault::RecordDamaged(Kept::Network); 2]);
}

// Shows B6.
#[test]
fn a_boot_after_a_reset_erases_nothing_for_something_may_be_held() {
    let mut sectors = Sectors::blank().saving(Kept::Settings, &settings(450));
    for n in 0..207u8 {
        sectors = sectors.saving(Kept::Network, &[n; 296]);
    }
    // The save makes the sector half full; the core hangs afterwards.
    let plant = Swing::new(1.3).sending(0.2, Down::Save).sending(1.0, s2(470)).at_rest();
    let options = Options { mishaps: vec![(0.6, Mishap::CoreHangs)], ..at_start(&sectors) };
    let run = run(plant, &options);
    assert_eq!(run.starts, [None, Some(Fault::WatchdogReset)]);
    assert_eq!(kept(&run), [Kept::Network, Kept::Settings], "there is room all the same");
    assert_eq!(run.flash.erases, 0);
}
