use super::*;

fn rectangle(left: usize, top: usize, right: usize, bottom: usize) -> Mask {
    let mut mask = Mask::EMPTY;
    mask.insert_block(left..right, top..bottom);
    mask
}

fn of(rectangles: &[(usize, usize, usize, usize)]) -> Mask {
    let mut mask = Mask::EMPTY;
    rectangles
        .iter()
        .for_each(|&(left, top, right, bottom)| mask.unite(&rectangle(left, top, right, bottom)));
    mask
}

/// About one pixel in `share`.
fn random(state: &mut u32, share: u32) -> Mask {
    let mut mask = Mask::EMPTY;
    for at in 0..PIXELS {
        *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        if (*state >> 8).is_multiple_of(share) {
            mask.insert(at % WIDTH, at / WIDTH);
        }
    }
    mask
}

/// Pixels of a mask within `reach` of each place.
fn for_each_count(mask: &Mask, reach: usize, mut each: impl FnMut(usize, usize, usize)) {
    for (x, y) in (0..WIDTH).flat_map(|x| (0..HEIGHT).map(move |y| (x, y))) {
        let rows = y.saturating_sub(reach)..(y + reach + 1).min(HEIGHT);
        let columns = x.saturating_sub(reach)..(x + reach + 1).min(WIDTH);
        let near = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
        each(x, y, near.filter(|&(x, y)| mask.contains(x, y)).count());
    }
}

#[test]
fn holes_are_filled_and_bays_are_not() {
    let mut ring = rectangle(40, 40, 200, 150);
    ring.subtract(&rectangle(50, 50, 190, 140));
    let mut filled = ring.clone();
    filled.fill_holes();
    assert_eq!(filled, rectangle(40, 40, 200, 150));
    // A way out of it: a bay, and nothing to fill.
    ring.subtract(&of(&[(100, 60, 102, 70), (120, 140, 121, 150)]));
    for open in [ring, Mask::EMPTY] {
        let mut filled = open.clone();
        filled.fill_holes();
        assert_eq!(filled, open);
    }
}

#[test]
fn small_pieces_go_and_large_ones_stay() {
    let large = [(10, 10, 50, 50), (100, 20, 130, 60)];
    let small = [(200, 5, 205, 10), (70, 200, 75, 203)];
    let mut mask = of(&[large, small].concat());
    mask.keep_large(25);
    assert_eq!(mask, of(&large));
    let spiral = of(&[
        (0, 0, 200, 2),
        (198, 0, 200, 200),
        (20, 198, 200, 200),
        (20, 100, 22, 200),
        (20, 100, 150, 102),
    ]);
    for one in [spiral, Mask::EMPTY] {
        let mut kept = one.clone();
        kept.keep_large(100);
        assert_eq!(kept, one);
    }
}

#[test]
fn what_is_near_stays_with_a_piece_and_what_is_far_goes() {
    let near = of(&[(10, 10, 60, 60), (80, 20, 100, 40), (120, 20, 140, 230)]);
    let far = rectangle(200, 20, 220, 40);
    let mut all = near.clone();
    all.unite(&far);
    for (by, kept) in [(&all, near), (&far, far.clone())] {
        let mut chain = all.clone();
        chain.keep_together(by, 25);
        assert_eq!(chain, kept);
    }
}

#[test]
fn a_pixel_is_what_most_of_its_neighbours_are() {
    let before = random(&mut 1, 2);
    let mut mask = before.clone();
    mask.majority();
    for_each_count(&before, 1, |x, y, count| assert_eq!(mask.contains(x, y), count >= 5, "{x} {y}"));
}

#[test]
fn growing_and_shrinking_are_what_is_around_each_pixel() {
    let mut state = 1;
    for (times, share) in
        [(0, 4), (1, 60), (2, 2), (3, 200), (7, 900), (16, 2_000), (31, 8_000), (40, 12_000)]
    {
        let mask = random(&mut state, share);
        let (mut grown, mut shrunk) = (mask.clone(), mask.clone());
        grown.dilate(times);
        shrunk.invert();
        shrunk.erode(times);
        for_each_count(&mask, times, |x, y, count| {
            assert_eq!(
                (grown.contains(x, y), shrunk.contains(x, y)),
                (count > 0, count == 0),
                "{times}: {x} {y}"
            );
        });
    }
}

#[test]
fn packing_is_the_bytes() {
    let bytes: Vec<u8> = (0..PIXELS).map(|at| (at * at % 7 == 2) as u8).collect();
    let mut mask = Mask::EMPTY;
    mask.pack(bytes.as_slice().try_into().unwrap());
    let (mut back, mut places) = (vec![0; PIXELS], vec![0; PIXELS]);
    mask.unpack(back.as_mut_slice().try_into().unwrap());
    mask.for_each(|at| places[at] = 1);
    assert_eq!((&back, &places), (&bytes, &bytes));
    assert!((0..PIXELS).all(|at| mask.contains(at % WIDTH, at / WIDTH) == (bytes[at] == 1)));
}

#[test]
fn moments_are_those_of_a_rectangle() {
    let mut filled = Mask::EMPTY;
    (100..120).for_each(|y| (60..160).for_each(|x| filled.insert(x, y)));
    assert_eq!(filled, rectangle(60, 100, 160, 120));
    let moments = filled.moments().unwrap();
    assert_eq!((moments.area, moments.middle), (2000, Point { x: 109.5, y: 109.5 }));
    assert!((moments.xx - (100.0 * 100.0 - 1.0) / 12.0).abs() < 0.01 && moments.xy.abs() < 0.01);
    assert!(moments.angle_rad().abs() < 1e-4 && moments.eccentricity() > 0.9);
    let mut slanted = Mask::EMPTY;
    (0..100).for_each(|at| slanted.insert(100 + at, 200 - at));
    assert!((slanted.moments().unwrap().angle_rad() + std::f32::consts::FRAC_PI_4).abs() < 1e-4);
    assert!(Mask::EMPTY.moments().is_none());
}
