use super::*;

fn rectangle(left: usize, top: usize, right: usize, bottom: usize) -> Mask {
    let (mut mask, mut block) = (Mask::EMPTY, Mask::EMPTY);
    (top..bottom).for_each(|y| (left..right).for_each(|x| mask.insert(x, y)));
    block.insert_block(left..right, top..bottom);
    assert_eq!(mask, block);
    mask
}

#[test]
fn holes_are_filled_and_bays_are_not() {
    let mut ring = rectangle(40, 40, 200, 150);
    let mut hole = rectangle(50, 50, 190, 140);
    hole.invert();
    ring.intersect(&hole);
    let mut filled = ring.clone();
    filled.fill_holes();
    assert_eq!(filled, rectangle(40, 40, 200, 150));
    // A winding way out of it: a bay, and nothing to fill.
    ring.invert();
    ring.unite(&rectangle(100, 60, 102, 70));
    ring.unite(&rectangle(120, 140, 121, 150));
    ring.invert();
    let mut open = ring.clone();
    open.fill_holes();
    assert_eq!(open, ring);
    let mut empty = Mask::EMPTY;
    empty.fill_holes();
    assert_eq!(empty, Mask::EMPTY);
}

#[test]
fn small_pieces_go_and_large_ones_stay() {
    let mut mask = rectangle(10, 10, 50, 50);
    mask.unite(&rectangle(100, 20, 130, 60));
    let large = mask.clone();
    mask.unite(&rectangle(200, 5, 205, 10));
    mask.unite(&rectangle(70, 200, 75, 203));
    mask.keep_large(25);
    assert_eq!(mask, large);
    // A winding piece is one.
    let mut spiral = rectangle(0, 0, 200, 2);
    spiral.unite(&rectangle(198, 0, 200, 200));
    spiral.unite(&rectangle(20, 198, 200, 200));
    spiral.unite(&rectangle(20, 100, 22, 200));
    spiral.unite(&rectangle(20, 100, 150, 102));
    let whole = spiral.clone();
    spiral.keep_large(100);
    assert_eq!(spiral, whole);
    let mut empty = Mask::EMPTY;
    empty.keep_large(25);
    assert_eq!(empty, Mask::EMPTY);
}

#[test]
fn what_is_near_stays_with_a_piece_and_what_is_far_goes() {
    let mut chain = rectangle(10, 10, 60, 60);
    chain.unite(&rectangle(80, 20, 100, 40));
    chain.unite(&rectangle(120, 20, 140, 230));
    let near = chain.clone();
    chain.unite(&rectangle(200, 20, 220, 40));
    let far = rectangle(200, 20, 220, 40);
    let (all, mut by_far) = (chain.clone(), chain.clone());
    chain.keep_together(&all, 25);
    assert_eq!(chain, near);
    by_far.keep_together(&far, 25);
    assert_eq!(by_far, far);
}

#[test]
fn a_pixel_is_what_most_of_its_neighbours_are() {
    let mut mask = Mask::EMPTY;
    let mut state = 1u32;
    for at in 0..PIXELS {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        if state >> 31 != 0 {
            mask.insert(at % WIDTH, at / WIDTH);
        }
    }
    let before = mask.clone();
    mask.majority();
    for (x, y) in (0..WIDTH).flat_map(|x| (0..HEIGHT).map(move |y| (x, y))) {
        let rows = y.saturating_sub(1)..(y + 2).min(HEIGHT);
        let columns = x.saturating_sub(1)..(x + 2).min(WIDTH);
        let near = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
        let count = near.filter(|&(x, y)| before.contains(x, y)).count();
        assert_eq!(mask.contains(x, y), count >= 5, "{x} {y}: {count}");
    }
}

#[test]
fn packing_is_the_bytes() {
    let bytes: Vec<u8> = (0..PIXELS).map(|at| (at * at % 7 == 2) as u8).collect();
    let mut mask = Mask::EMPTY;
    mask.pack(bytes.as_slice().try_into().unwrap());
    assert!((0..PIXELS).all(|at| mask.contains(at % WIDTH, at / WIDTH) == (bytes[at] == 1)));
    let mut back = vec![0; PIXELS];
    mask.unpack(back.as_mut_slice().try_into().unwrap());
    assert_eq!(back, bytes);
    let mut places = Vec::new();
    mask.for_each(|at| places.push(at));
    assert_eq!(places.len() as u32, mask.count());
    assert!(places.iter().all(|&at| bytes[at] == 1));
}

#[test]
fn moments_are_those_of_a_rectangle() {
    let moments = rectangle(60, 100, 160, 120).moments().unwrap();
    assert_eq!((moments.area, moments.middle), (2000, Point { x: 109.5, y: 109.5 }));
    assert!((moments.xx - (100.0 * 100.0 - 1.0) / 12.0).abs() < 0.01 && moments.xy.abs() < 0.01);
    assert!(moments.angle_rad().abs() < 1e-4 && moments.eccentricity() > 0.9);
    let mut slanted = Mask::EMPTY;
    (0..100).for_each(|at| slanted.insert(100 + at, 200 - at));
    assert!((slanted.moments().unwrap().angle_rad() + std::f32::consts::FRAC_PI_4).abs() < 1e-4);
    assert!(Mask::EMPTY.moments().is_none());
}

#[test]
fn an_outline_is_its_pixels_and_overlap_is_the_share_of_what_is_in_either() {
    // A notch makes it a polygon that is not convex.
    let corners = [(9.5, 9.5), (19.5, 9.5), (19.5, 29.5), (14.5, 19.5), (9.5, 29.5)];
    let outlined = Mask::of_outline(&corners);
    assert!(outlined.contains(10, 10) && outlined.contains(19, 10) && outlined.contains(10, 26));
    assert!(!outlined.contains(20, 10) && !outlined.contains(15, 25) && !outlined.contains(10, 30));
    let square = Mask::of_outline(&[(9.5, 9.5), (19.5, 9.5), (19.5, 19.5), (9.5, 19.5)]);
    assert_eq!(square, rectangle(10, 10, 20, 20));
    assert_eq!(square.overlap(&rectangle(15, 10, 25, 20)), 50.0 / 150.0);
    assert_eq!((square.overlap(&square), square.overlap(&Mask::EMPTY)), (1.0, 0.0));
    assert_eq!(Mask::EMPTY.overlap(&Mask::EMPTY), 0.0);
}

#[test]
fn growing_and_shrinking_are_what_is_around_each_pixel() {
    let mut state = 1u32;
    for (times, share) in
        [(0, 4), (1, 60), (2, 2), (3, 200), (7, 900), (16, 2_000), (31, 8_000), (40, 12_000)]
    {
        let mut mask = Mask::EMPTY;
        for at in 0..PIXELS {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            if (state >> 8).is_multiple_of(share) {
                mask.insert(at % WIDTH, at / WIDTH);
            }
        }
        let (mut grown, mut shrunk) = (mask.clone(), mask.clone());
        grown.dilate(times);
        shrunk.invert();
        shrunk.erode(times);
        for (x, y) in (0..WIDTH).flat_map(|x| (0..HEIGHT).map(move |y| (x, y))) {
            let rows = y.saturating_sub(times)..(y + times + 1).min(HEIGHT);
            let columns = x.saturating_sub(times)..(x + times + 1).min(WIDTH);
            let is_near = rows.into_iter().any(|y| columns.clone().any(|x| mask.contains(x, y)));
            assert_eq!(
                (grown.contains(x, y), shrunk.contains(x, y)),
                (is_near, !is_near),
                "{times}: {x} {y}"
            );
        }
    }
}
