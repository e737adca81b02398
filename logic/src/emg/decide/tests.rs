use super::*;

static F: Fitted = Fitted {
    mean_frames: 10,
    begins: [450, 690],
    ends: [450, 500],
    hysteresis: 250,
    least_end: 200,
    fall: 300,
    least_fall: 1_200,
    crest_frames: 320,
    rise: 400,
    least_rise: 600,
    least_spreads: 3,
    place_begins: 480,
    place_stays: [520, 400],
    dwell: [2, 5, 3, 6],
    rest_frames: 341,
    after_frames: [40, 80],
    after_dwell: 12,
    firmer: 270,
    both: 300,
    busy: 450,
};
const WEAK: [[i32; 2]; 4] = [[15_600, 15_700], [16_850, 16_100], [15_750, 16_940], [100, 150]];

fn model([rest, close, open, spread]: [[i32; 2]; 4]) -> EmgModel {
    EmgModel::new(rest, close, open, spread, 9_000).unwrap()
}

fn sites() -> Sites {
    Sites::of(&F, &model(WEAK))
}

fn swapped(levels: [[i32; 2]; 4]) -> [[i32; 2]; 4] {
    levels.map(|[flexor, extensor]| [extensor, flexor])
}

#[test]
fn a_wearers_levels_are_those_of_the_calibration() {
    let weak = sites();
    assert_eq!((weak.crossed, weak.rest, weak.span), (false, [15_600, 15_700], [1_250, 1_240]));
    assert_eq!(weak.rest_uv.map(level_of), weak.rest);
    assert_eq!((weak.begins, weak.ends, weak.fall), ([480, 690], [280, 489], [960, 967]));
    assert_eq!((weak.both, weak.hears), ([622, 420], [150, 0]));
    assert_eq!((weak.close_ratio, weak.turn, weak.beside), (-850, 1_940, 422));
    assert_eq!((weak.other, weak.works_uv.map(level_of)), ([400, 150], [15_900, 15_997]));
    assert_eq!(weak.active_uv.map(|own| own.map(level_of)), [[16_037, 15_912], [16_134, 16_010]]);
    let noisy = Sites::of(&F, &model([[15_600, 15_700], [17_600, 16_200], [15_900, 17_800], [450, 510]]));
    assert_eq!((noisy.begins, noisy.ends, noisy.fall), ([675, 728], [450, 500], [600, 571]));
    assert_eq!((noisy.both, noisy.hears), ([538, 450], [250, 150]));
    let loud = Sites::of(&F, &model([[17_800, 15_700], [20_000, 17_700], [17_700, 19_800], [100, 100]]));
    assert_eq!(
        loud.active_uv.map(|own| own.map(level_of)),
        [[18_100, 18_000], [15_700 + 4_100 * 350 / 1_000, 15_700 + 4_100 / 4]]
    );
    assert_eq!((loud.both, loud.hears), ([787, 300], [500, 0]));
    assert_eq!((loud.fall, loud.beside), ([545, 300], 587));
    let alike = Sites::of(&F, &model([[15_600; 2], [18_600, 16_800], [15_800, 16_900], [100; 2]]));
    assert_eq!(alike.beside, STRONG);
}

#[test]
fn electrodes_that_are_swapped_are_the_same_wearer() {
    for (levels, sites) in [(WEAK, [0, 1]), (swapped(WEAK), [1, 0])] {
        let mut decide = Decide::with(&F, Some(&model(levels)));
        assert_eq!(sites.map(|n| decide.active_uv(n).map(level_of)), [[16_037, 15_912], [16_134, 16_010]]);
        for (wish, site, hears) in
            [(Wish::Rest, 1, None), (Wish::Close, 0, Some([15_700, 150])), (Wish::Open, 1, None)]
        {
            decide.machine.wish = wish;
            assert_eq!((decide.mover(), decide.hears()), (sites[site], hears), "{wish:?}");
        }
    }
    let mut nobody = Decide::with(&F, None);
    for (wish, mover, strength) in [(Wish::Rest, 1, 0), (Wish::Close, 0, 545), (Wish::Open, 1, 500)] {
        nobody.take(&[Electrode::default(); 2]);
        nobody.machine.wish = wish;
        assert_eq!((nobody.mover(), nobody.hears()), (mover, Some([FLOOR_LEVEL, DEFAULT_HEARS[mover]])));
        assert_eq!(nobody.strength_permille(), strength);
        assert_eq!(nobody.active_uv(0), ACTIVE_UV);
    }
}

#[derive(Clone, Copy)]
struct State {
    wish: Wish,
    mean: [i32; 3],
    since: [i32; 2],
    trough: [i32; 2],
    crest: i32,
    held: i32,
    blind: [bool; 2],
    over: bool,
}

const CALM: State = State {
    wish: Wish::Rest,
    mean: [0; 3],
    since: [1_000; 2],
    trough: [0; 2],
    crest: 0,
    held: 0,
    blind: [false; 2],
    over: false,
};

fn asked(state: State) -> (Wish, Machine) {
    let State { wish, mean, since, trough, crest, held, blind, over } = state;
    let sites = Sites { fall: [300; 2], ..sites() };
    let mut machine =
        Machine { wish, mean: mean.map(|mean| mean * 16), since, trough, crest, held, ..Machine::new(&F) };
    (machine.wanted(&sites, blind, over), machine)
}

fn wants(state: State) -> Wish {
    asked(state).0
}

#[test]
fn opening_begins_from_its_share_and_place_while_the_other_site_is_calm() {
    let opens = State { mean: [0, 690, 480], ..CALM };
    for (state, begins) in [
        (opens, true),
        (State { mean: [0, 689, 480], ..opens }, false),
        (State { mean: [0, 690, 479], ..opens }, false),
        (State { mean: [419, 690, 480], ..opens }, true),
        (State { mean: [420, 690, 480], ..opens }, false),
        (State { blind: [false, true], ..opens }, false),
        (State { blind: [true, false], ..opens }, true),
        // Soon after other activity: not yet, only strongly, like any other. This frame counts.
        (State { since: [78, 1_000], ..opens }, false),
        (State { since: [79, 1_000], ..opens }, true),
        (State { since: [39, 1_000], mean: [0, 999, 480], ..opens }, false),
        (State { since: [39, 1_000], mean: [0, 1_000, 480], ..opens }, true),
        (State { since: [38, 1_000], mean: [0, 1_000, 480], ..opens }, false),
        (State { trough: [0, 400], mean: [0, 799, 480], ..opens }, false),
        (State { trough: [0, 400], mean: [0, 800, 480], ..opens }, true),
    ] {
        let expected = if begins { Wish::Open } else { Wish::Rest };
        assert_eq!(wants(state), expected, "{:?} {:?}", state.mean, state.since);
        if state.mean[0] == 0 {
            assert_eq!(
                wants(State { wish: Wish::Close, ..state }),
                expected,
                "from closing: {:?}",
                state.mean
            );
        }
    }
}

#[test]
fn closing_begins_from_its_share_and_place_while_nothing_opens() {
    let closes = State { mean: [480, 0, 480], ..CALM };
    let blind = State { blind: [false, true], ..closes };
    // It was hidden, has not fallen, and no opening would go on.
    let held = State { trough: [600, 0], held: 600 * 256, ..closes };
    for (state, begins) in [
        (closes, true),
        (State { mean: [479, 0, 480], ..closes }, false),
        (State { mean: [480, 0, 481], ..closes }, false),
        (State { mean: [480, 621, 480], ..closes }, true),
        (State { mean: [480, 622, 480], ..closes }, false),
        // Both muscles more, by a firmer fist.
        (State { mean: [1_100, 721, 480], ..closes }, true),
        (State { mean: [1_100, 722, 480], ..closes }, false),
        (State { over: true, ..closes }, false),
        (State { blind: [true, false], ..closes }, false),
        (State { mean: [899, 0, 480], ..blind }, false),
        (State { mean: [900, 0, 480], ..blind }, true),
        (State { trough: [100, 0], mean: [499, 0, 480], ..closes }, false),
        (State { trough: [100, 0], mean: [500, 0, 480], ..closes }, true),
        (State { mean: [299, 0, 399], ..held }, false),
        (State { mean: [300, 0, 399], ..held }, true),
        (State { mean: [300, 0, 400], ..held }, false),
        (State { mean: [500, 921, 399], ..held }, true),
        (State { mean: [500, 922, 399], ..held }, false),
        (State { mean: [999, 0, 399], held: 0, ..held }, false),
    ] {
        let expected = if begins { Wish::Close } else { Wish::Rest };
        assert_eq!(wants(state), expected, "{:?}", state.mean);
        let expected = if state.over { Wish::Open } else { expected };
        let open =
            State { wish: Wish::Open, mean: [state.mean[0], state.mean[1].min(400), state.mean[2]], ..state };
        if state.mean[1] == 0 && !state.blind[0] {
            assert_eq!(wants(open), expected, "from opening: {:?}", state.mean);
        }
    }
}

#[test]
fn a_wish_goes_on_until_it_falls_below_its_end_or_from_its_crest() {
    let closes = State { wish: Wish::Close, mean: [280, 0, 520], ..CALM };
    let busy = State { since: [0, 1_000], ..closes };
    let crest = State { crest: 1_000 * 256, ..closes };
    for (state, stays) in [
        (closes, true),
        (State { mean: [279, 0, 520], ..closes }, false),
        (State { mean: [280, 0, 521], ..closes }, false),
        (State { mean: [280, 921, 520], ..busy }, true),
        (State { mean: [280, 922, 520], ..busy }, false),
        (State { over: true, ..closes }, false),
        (State { blind: [true, false], ..closes }, false),
        (State { mean: [699, 0, 520], ..crest }, true),
        (State { mean: [698, 0, 520], ..crest }, false),
    ] {
        assert_eq!(wants(state), if stays { Wish::Close } else { Wish::Rest }, "{:?}", state.mean);
    }
    let opens = State { wish: Wish::Open, mean: [0, 489, 400], ..CALM };
    let crest = State { crest: 1_000 * 256, ..opens };
    for (state, stays) in [
        (opens, true),
        (State { mean: [0, 488, 400], ..opens }, false),
        (State { mean: [0, 489, 399], ..opens }, false),
        (State { mean: [0, 489, 399], blind: [true, false], ..opens }, true),
        (State { mean: [0, 488, 399], blind: [true, false], ..opens }, false),
        (State { mean: [0; 3], over: true, ..opens }, true),
        (State { mean: [0, 699, 400], ..crest }, true),
        (State { mean: [0, 698, 400], ..crest }, false),
    ] {
        assert_eq!(wants(state), if stays { Wish::Open } else { Wish::Rest }, "{:?}", state.mean);
    }
}

#[test]
fn crest_trough_and_activity_are_remembered() {
    let closes = State { wish: Wish::Close, mean: [700, 300, 0], crest: 256_000, trough: [900, 200], ..CALM };
    let (_, after) = asked(closes);
    assert_eq!((after.crest, after.trough), (255_760, [700, 200]));
    let (_, after) = asked(State { mean: [1_200, 100, 0], ..closes });
    assert_eq!((after.crest, after.trough), (1_200 * 256, [1_200, 100]));
    assert_eq!((after.held, asked(State { wish: Wish::Rest, ..closes }).1.crest), (after.crest, 0));
    let since = |state| asked(state).1.since;
    for (mean, blind, busy) in [
        ([450, 0, 479], false, true),
        ([449, 449, 479], false, false),
        ([0, 450, 479], false, true),
        ([450, 0, 480], false, false),
        ([450, 0, 479], true, false),
    ] {
        let state = State { mean, blind: [blind, false], since: [7, 7], ..CALM };
        assert_eq!(since(state), [if busy { 0 } else { 8 }, 8], "{mean:?}");
        assert_eq!(since(State { wish: Wish::Open, ..state })[1], 0);
    }
}

fn read(levels: [i32; 2], since: i32, of: impl Fn(&mut [Electrode; 2])) -> Machine {
    read_by(0, levels, since, of)
}

fn read_by(spread: i32, levels: [i32; 2], since: i32, of: impl Fn(&mut [Electrode; 2])) -> Machine {
    let mut electrodes = levels.map(|level| Electrode { uv: Some(uv_of(level)), ..Electrode::default() });
    of(&mut electrodes);
    let mut machine = Machine { since: [since; 2], ..Machine::new(&F) };
    let model = model(WEAK).with_close_spread(spread).unwrap();
    machine.calibrated(&Sites::of(&F, &model), electrodes.each_ref());
    machine
}

#[test]
fn what_is_above_all_that_was_calibrated_is_strong() {
    let none = |_: &mut [Electrode; 2]| {};
    let still = |electrodes: &mut [Electrode; 2]| electrodes[0].still = true;
    let doubted = |electrodes: &mut [Electrode; 2]| electrodes[0].doubted = true;
    let blind = |electrodes: &mut [Electrode; 2]| electrodes[0].uv = None;
    let over = |electrodes: &mut [Electrode; 2]| electrodes[1].over = true;
    for (is_strong, machine) in [
        (true, read([15_600, 16_940], 1_000, none)),
        (false, read([15_600, 16_939], 1_000, none)),
        (true, read([16_499, 16_940], 1_000, none)),
        (false, read([16_500, 16_940], 1_000, none)),
        (true, read([16_500, 16_940], 1_000, still)),
        (true, read([16_758, 16_940], 1_000, still)),
        (false, read([16_759, 16_940], 1_000, still)),
        (true, read_by(400, [16_491, 16_940], 1_000, still)),
        (false, read_by(400, [16_492, 16_940], 1_000, still)),
        (true, read_by(400, [16_759, 16_940], 1_000, doubted)),
        (true, read([16_759, 16_940], 1_000, blind)),
        (true, read([15_600, 16_940], 39, none)),
        (false, read([15_600, 17_209], 38, none)),
        (true, read([15_600, 17_210], 38, none)),
        (true, read([15_600, 16_940], 0, doubted)),
        (false, read([15_600, 16_940], 1_000, over)),
        (false, read([15_600, 16_940], 1_000, |electrodes| electrodes[1].uv = None)),
    ] {
        assert_eq!(machine.wish == Wish::Open, is_strong, "{:?}", machine.mean);
    }
    // An opening at once has the shares and the place of its frame; else a tenth of them is averaged. What follows rest is subtracted.
    let opened = [0, 1_000, 1_077].map(|own| 16 * own);
    assert_eq!(read([15_600, 16_940], 1_000, none).mean, opened);
    assert_eq!(read([15_600, 16_320], 1_000, none).mean, [0, 800, 1_211]);
    let mut hums = Machine { drift: [0, 20_000 << 8], since: [1_000; 2], ..Machine::new(&F) };
    let uv = [uv_of(15_600), uv_of(16_940) + 20_000].map(Some);
    hums.calibrated(&sites(), uv.map(|uv| Electrode { uv, ..Electrode::default() }).each_ref());
    assert_eq!((hums.mean, hums.wish), (opened, Wish::Open));
}

#[test]
fn a_wish_stands_for_its_dwell() {
    let takes = |from: Wish, to: Wish, since: i32, place: i32| {
        let mean = [0, 0, 16 * place];
        let mut machine = Machine { wish: from, next: from, since: [1_000, since], mean, ..Machine::new(&F) };
        (1..100).find(|_| {
            machine.settle(to);
            machine.wish == to
        })
    };
    assert_eq!(takes(Wish::Close, Wish::Rest, 1_000, 520), Some(5), "ripple");
    assert_eq!(takes(Wish::Close, Wish::Rest, 1_000, 521), Some(2));
    assert_eq!(takes(Wish::Open, Wish::Rest, 1_000, 0), Some(2));
    assert_eq!(takes(Wish::Rest, Wish::Close, 40, 0), Some(3));
    assert_eq!(takes(Wish::Rest, Wish::Close, 39, 0), Some(12));
    assert_eq!(takes(Wish::Rest, Wish::Open, 0, 0), Some(6));
}

#[test]
fn rest_is_followed_after_half_a_second_of_it_and_hum_at_once() {
    let sites = sites();
    let follows = |machine: Machine, above: [i32; 2], wish: Wish, hums: bool, frames: u16| {
        let mut machine = machine;
        let uv = [0, 1].map(|n: usize| Some(sites.rest_uv[n] + above[n]));
        let electrodes = uv.map(|uv| Electrode { uv, hums, ..Electrode::default() });
        (0..frames).for_each(|_| machine.follow(&sites, electrodes.each_ref(), wish));
        machine.drift
    };
    let calm = || Machine::new(&F);
    let above = [40_000, 20_000];
    assert_eq!(follows(calm(), above, Wish::Rest, false, CALM_FRAMES - 1), [0; 2]);
    assert_eq!(follows(calm(), above, Wish::Rest, false, CALM_FRAMES), [30_029, 15_014]);
    assert_eq!(follows(calm(), above, Wish::Rest, false, CALM_FRAMES + 1), [59_970, 29_984]);
    assert_eq!(follows(calm(), above, Wish::Rest, true, 1), [487_619, 243_809]);
    assert_eq!(follows(calm(), [2_000_000; 2], Wish::Rest, true, 1), [18_285_714; 2]);
    let lasts = 2 * CALM_FRAMES;
    assert_eq!(follows(calm(), above, Wish::Close, false, lasts), [0; 2]);
    for (machine, is_calm) in [
        (Machine { wish: Wish::Open, ..calm() }, false),
        (Machine { mean: [16 * 450, 0, 0], ..calm() }, false),
        (Machine { mean: [16 * 450 - 1, 16 * 500 - 1, 0], ..calm() }, true),
        (Machine { mean: [0, 16 * 500, 0], ..calm() }, false),
    ] {
        assert_eq!(follows(machine, above, Wish::Rest, false, lasts) != [0; 2], is_calm);
    }
    let mut lost = calm();
    (0..lasts).for_each(|_| lost.follow(&sites, [&Electrode::default(); 2], Wish::Rest));
    assert_eq!(lost.drift, [0; 2]);
}

#[test]
fn without_calibration_a_wish_stands_out_by_what_is_set_and_for_so_long() {
    let at = |uv: Option<i32>| Electrode { uv, over: uv == Some(OVER_UV), ..Electrode::default() };
    let lacks = |uv: i32, by: i32| uv_of(level_of(uv) - by);
    let next = |wish: Wish, uv: [Option<i32>; 2]| {
        let mut machine = Machine { wish, next: wish, ..Machine::new(&F) };
        machine.uncalibrated(&uv.map(at));
        machine.next
    };
    let [close_uv, open_uv] = DEFAULT_BEGINS_UV;
    for (from, slack) in [(Wish::Rest, 0), (Wish::Close, 512), (Wish::Open, 0)] {
        let uv = lacks(close_uv, slack);
        for (other, expected) in [(1_322 - slack, Wish::Close), (1_321 - slack, Wish::Rest)] {
            assert_eq!(next(from, [Some(uv), Some(lacks(uv, other))]), expected, "{from:?}");
        }
        assert_eq!(next(from, [Some(lacks(uv, 1)), Some(0)]), Wish::Rest, "{from:?}");
    }
    for (from, slack) in [(Wish::Rest, 0), (Wish::Open, 512), (Wish::Close, 0)] {
        let uv = lacks(open_uv, slack);
        for (other, expected) in [(2_900 - slack, Wish::Open), (2_899 - slack, Wish::Rest)] {
            assert_eq!(next(from, [Some(lacks(uv, other)), Some(uv)]), expected, "{from:?}");
        }
        assert_eq!(next(from, [None, Some(uv)]), Wish::Open);
        assert_eq!(next(from, [None, Some(lacks(uv, 1))]), Wish::Rest);
    }
    // Saturated: it goes on opening, and permits nothing else. Without a number it permits no closing.
    assert_eq!(next(Wish::Open, [Some(2_900_000), Some(OVER_UV)]), Wish::Open);
    assert_eq!(next(Wish::Rest, [None, Some(OVER_UV)]), Wish::Rest);
    assert_eq!(next(Wish::Rest, [None, Some(OVER_UV - 1)]), Wish::Open);
    assert_eq!(next(Wish::Rest, [Some(close_uv), None]), Wish::Rest);

    let mut decide = Decide::with(&F, None);
    let closes = [Some(close_uv), Some(0)].map(at);
    let stands = (1..200).find(|_| decide.take(&closes) == Wish::Close);
    assert_eq!(stands, Some(DEFAULT_FRAMES));
    assert_eq!(decide.take(&[Electrode { uv: Some(0), ..Electrode::default() }; 2]), Wish::Rest);
}

#[test]
fn the_other_electrode_takes_part_as_calibrated_or_not() {
    // Levels of rest, closing and opening: the extensor rises by 2000 with the flexor's 3000, the flexor by 1000 with the extensor's 4000.
    let levels = [[15_600, 15_700], [18_600, 17_700], [16_600, 19_700], [100, 150]];
    let of = |decide: &Decide, electrode: usize, levels: [Option<i32>; 2]| {
        let uv = levels.map(|level| level.map(uv_of));
        let mut decide = decide.clone();
        decide.take(&uv.map(|uv| Electrode { uv, ..Electrode::default() }));
        decide.parts()[decide.site_of(electrode)]
    };
    let calibrated = Decide::with(&F, Some(&model(levels)));
    let far = |level: i32| Some(15_700 + level);
    for (flexor, extensor, part) in [
        (Some(15_600 + 719), far(0), Part::Rest),
        (Some(15_600 + 721), far(0), Part::Unheard),
        (Some(18_600), far(498), Part::Unheard),
        (Some(18_600), far(502), Part::Unknown),
        (Some(18_600), far(998), Part::Unknown),
        (Some(18_600), far(1_002), Part::Heard),
        // Above its calibrated level an electrode expects no more.
        (Some(19_600), far(1_002), Part::Heard),
        (Some(18_600), None, Part::Unknown),
        (None, far(1_002), Part::Rest),
    ] {
        assert_eq!(of(&calibrated, 0, [flexor, extensor]), part, "{flexor:?} {extensor:?}");
    }
    for (flexor, part) in [(15_723, Part::Unheard), (15_727, Part::Unknown), (16_102, Part::Heard)] {
        assert_eq!(of(&calibrated, 1, [Some(flexor), Some(19_700)]), part, "{flexor}");
    }
    let weak = Decide::with(&F, Some(&model(WEAK)));
    assert_eq!(
        of(&weak, 1, [Some(15_600), Some(16_940)]),
        Part::Unknown,
        "it is hardly driven by an opening"
    );
    let nobody = Decide::with(&F, None);
    for (mv, part) in [(158, Part::Rest), (160, Part::Unknown)] {
        assert_eq!(of(&nobody, 0, [Some(level_of(mv * 1_000)), Some(15_700)]), part);
    }
}
