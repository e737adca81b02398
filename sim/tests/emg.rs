//! The whole way of real recordings of two muscles: a calibration from other recordings, the front end, the board's logic, the motor.

use tenax_sim::replay::calibrate::calibrate;
use tenax_sim::replay::meaning::Motion;
use tenax_sim::session::{self, Board, ReplayOptions};

#[test]
#[cfg_attr(not(recordings), ignore = "no recordings in ../shared/data")]
fn a_replayed_fist_never_opens_the_hand_and_rest_never_moves_it() {
    let folder = crate::common::shared("");
    for prefix in ["", "b_"] {
        let path = |name: &str| folder.join(format!("emg_two_channel_{prefix}{name}.csv"));
        let phases = ["rest0", "handflexion0", "handextension0"].map(path);
        let model = calibrate(&phases, None, 1).expect("it separates");
        for name in ["rest1", "fist0", "fist1", "fist3", "fist_dynamic", "handflexion1", "handextension1"] {
            if !path(name).exists() {
                continue;
            }
            for calibrated in [Some(model), None] {
                let options = ReplayOptions { calibrated, ..ReplayOptions::default() };
                let outcome =
                    session::replay_served(&path(name), options, 1, &Board::Host, &mut (), &mut |_| {});
                let report = outcome.expect("a shared recording is good").report;
                let (wearer, replay) = (report.wearer, report.replay.expect("it is a replay"));
                let meant = replay.meant.expect("the recipe says what it means");
                assert_eq!(wearer.faults, 0, "{name}: each is a muscle");
                assert!(meant.wrong_ms <= 50.0, "{name}: {meant:?}");
                assert!(meant.wrong_ms == 0.0 || !meant.never.contains(&Motion::Close), "{name}: {meant:?}");
                let wanted_s = meant.wanted_s.filter(|_| calibrated.is_some());
                assert!(wanted_s.is_none_or(|wanted_s| wanted_s > 4.0), "{name}: {meant:?}");
            }
        }
    }
}
