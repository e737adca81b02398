//! Every mistake gets one message: file, line, key, and what is allowed.

use tenax_scene::SceneFile;

const GOOD: &str = concat!(
    "name = \"n\"\ntitle = \"t\"\n",
    crate::common::grasp!(),
    r#"[[fault]]
at_s = 1
channel = "fsr_a"
kind = "dead"
reason = "wire"
[[command]]
at_s = 2
kind = "set-s2-permille"
value = 300
[[muscle]]
at_s = 3
for_s = 1
intent = "close"
level_mv = 500
"#
);

/// Text of the good file | its replacement, with `\n` for a new line | the line that the message names | its words.
const MISTAKES: &str = r#"
mu_s = 0.5 | mu_s = 50 | 7 | mu_s, 50, 0.05..=3
mu_s = 0.5 | mu_s = nan | 7 | mu_s, NaN, 0.05..=3
mu_s = 0.5 | mu_s = "much" | 7 | mu_s, string, f64
mu_s = 0.5 | mu_s =  | 7 | mu_s
mu_s = 0.5\n |  | 6 | missing, mu_s
mu_d = 0.4 | mu_d = 0.6 | 8 | mu_d = 0.6, mu_s = 0.5
mu_d = 0.4 | mu_dyn = 0.4 | 8 | mu_dyn, expected, mu_d
mass_kg = 0.2 | mass_kg = -0.2 | 12 | mass_kg, -0.2, 0.0005..=20
mass_kg = 0.2\nwidth_mm = 60\nstiffness_n_per_mm = 3 | mass_kg = 0.0005\nwidth_mm = 60\nstiffness_n_per_mm = 3\n[table]\nmat_n_per_mm = 1000 | 11 | mass_kg, mat_n_per_mm, 23 us, 125 us
stiffness_n_per_mm = 3 | stiffness_n_per_mm = 1000\n[gripper]\nspeed_mm_s = 500\nforce_n = 1 | 11 | gripper, stiffness_n_per_mm, 4 us, 125 us
mass_kg = 0.2 | mass_g = 200 | 12 | mass_g, mass_kg
duration_s = 10 | duration_s = inf | 4 | duration_s, inf, 3600
duration_s = 10 | duration_s = 0 | 4 | duration_s, 0 is outside
at_s = 3 | at_s = 30 | 25 | 30 s, duration_s = 10
"fsr_a" | "fsr_e" | 17 | fsr_e, fsr_a, fsr_b
"dead" | "gone" | 18 | gone, dead, stuck
"dead" | "pressed" | 17 | press_n
"dead" | "swapped" | 17 | with
"dead" | "swapped"\nwith = "fsr_a" | 19 | with, itself
"dead" | "dead"\nuntil_s = 0.5 | 19 | until_s = 0.5, at_s = 1
value = 300 | value = 9000 | 23 | 9000, 50..=1500, s2-permille
value = 300 | value = -1 | 23 | value
value = 300\n |  | 22 | needs value
"close" | "shut" | 27 | shut, close, open, both
[object] | [objekt] | 11 | objekt, object
[[muscle]] | [[press]]\nat_s = 1\nfor_s = 1\nload_n = 1\n[[muscle]] | 25 | [[press]], [object]
[[muscle]] | [robot]\n[[muscle]] | 24 | [robot], [object]
[[muscle]] | [gripper]\nopening_mm = 120\n[[muscle]] | 25 | opening_mm = 120, range_mm = 100
[[muscle]] | [[electrode_lift]]\nat_s = 1\nfor_s = 1\nchannel = "pvdf_1"\npickup_mv = 1\n[[muscle]] | 27 | pvdf_1, myo_flexor
pitch_mm = 1 | pitch_mm = 1\nlevel = "l3" | 11 | l3, l0, l1
pitch_mm = 1 | pitch_mm = 1\nlevel = "l1"\nskin_n_per_mm = -1 | 12 | skin_n_per_mm, 0.01..=1000
stiffness_n_per_mm = 3 | stiffness_n_per_mm = 3\ncrush_n = nan | 15 | crush_n, NaN
[[fault]] | [pitch]\noffset_mm = 500\nhang_mm = 1\ngyration_mm = 9\n[[fault]] | 16 | offset_mm, -100..=100
[[fault]] | [strain]\ncreep = 2\n[[fault]] | 16 | creep, 0..=1
[[fault]] | [array]\ntilt = -0.1\n[[fault]] | 16 | tilt, 0..=1
[[fault]] | [camera]\nrate_hz = 0\n[[fault]] | 16 | rate_hz, 0.01..=1000
[[fault]] | [[jam]]\nat_s = 1\nfor_s = 0\n[[fault]] | 17 | for_s, 0 is outside
[[fault]] | [[jam]]\nat_s = 11\nfor_s = 1\n[[fault]] | 16 | 11 s, duration_s = 10
[[fault]] | [[jam]]\nat_s = 1\n[[fault]] | 15 | missing, for_s
[[fault]] | [[jam]]\nat_s = 1\nfor_s = 1\nteeth = 3\n[[fault]] | 18 | teeth, at_s, for_s
[[fault]] | [gripper]\nstep_mm = 50\n[[fault]] | 16 | step_mm, 0..=20
[[muscle]] | [[fill]]\nat_s = 1\nfor_s = 1\nadd_kg = -1\n[[muscle]] | 27 | add_kg, above 0
"#;

#[test]
fn every_mistake_is_named_where_it_stands() {
    SceneFile::parse(GOOD, "good.toml").unwrap();
    for row in MISTAKES.trim().lines() {
        let [good, bad, line, said] = row.split(" | ").collect::<Vec<_>>()[..] else { panic!("{row}") };
        let text = GOOD.replacen(&good.replace("\\n", "\n"), &bad.replace("\\n", "\n"), 1);
        assert_ne!(text, GOOD, "{good} stands in the good file");
        let message = SceneFile::parse(&text, "bad.toml").expect_err(bad).to_string();
        assert!(message.starts_with(&format!("bad.toml:{line}: ")), "{bad}: {message}");
        assert!(!message.contains('\n'), "{message}");
        for word in said.split(", ") {
            assert!(message.contains(word), "{bad}: `{word}` is missing in: {message}");
        }
    }
}

#[test]
fn a_scene_about_nothing_says_what_it_needs() {
    let text = GOOD.replace("[object]\nmass_kg = 0.2\nwidth_mm = 60\nstiffness_n_per_mm = 3\n", "");
    let message = SceneFile::parse(&text, "bad.toml").unwrap_err().to_string();
    assert!(message.contains("[object]") && message.contains("[robot]"), "{message}");
}

#[test]
fn no_text_makes_it_panic() {
    for text in ["", "\u{0}", "=", "[", "[contact", "name = \"\u{1F980}", "\u{FEFF}", "duration_s = 1e999"] {
        SceneFile::parse(text, "bad.toml").expect_err(text);
    }
    // Cut anywhere, it is an error or a scene, never a panic.
    for cut in 0..GOOD.len() {
        let _ = SceneFile::parse(&GOOD[..cut], "bad.toml");
    }
}
