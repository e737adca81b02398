//! `tenax monitor --web` in a real browser: what a person sees of a scene that runs, and does with it.

use std::thread;
use std::time::{Duration, Instant};

use tenax_logic::setting::SettingId;

use crate::browser::Page;
use crate::page_bench::Web;
use crate::serving::Serving;

const WITHIN: Duration = Duration::from_secs(40);

fn until(page: &mut Page, condition: &str) {
    let began = Instant::now();
    // What the page has not loaded yet is not so.
    let asked = format!("(() => {{ try {{ return {condition} }} catch {{ return false }} }})()");
    while page.value(&asked) != true {
        assert!(began.elapsed() < WITHIN, "never: {condition}\n{}", page.value("document.body.innerText"));
        thread::sleep(Duration::from_millis(50));
    }
}

/// Points of a plot in this colour, red, green and blue.
fn points(page: &mut Page, plot: &str, [r, g, b]: [u8; 3]) -> u64 {
    let count = format!(
        "(() => {{ const c = document.getElementById('{plot}'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; \
         let n = 0; for (let i = 0; i < d.length; i += 4) \
         if (Math.abs(d[i] - {r}) + Math.abs(d[i + 1] - {g}) + Math.abs(d[i + 2] - {b}) < 90) n++; return n; }})()"
    );
    page.value(&count).as_u64().unwrap()
}

#[test]
#[cfg_attr(not(chromium), ignore = "no Chromium here: TENAX_CHROMIUM names one that is not on PATH")]
fn a_person_sees_the_board_beside_the_truth_zooms_pauses_and_sets_a_setting() {
    // The glass is grasped within a second, and with that the consent of who switched the board on is over.
    let glass = include_str!("../../../scenes/glass.toml");
    let glass = glass.replacen("\n[contact]", "\nline_trusted = true\n\n[contact]", 1);
    let mut served = Serving::start_telling(&glass);
    let web = Web::watching(&served.places[0], &["--control", "--truth", &served.places[1]]);
    let mut page = Page::open(&web.url);

    until(&mut page, "at('mode').textContent !== '-' && points.length > 40");
    let settings = format!("document.querySelectorAll('#settings tr').length === {}", SettingId::ALL.len());
    until(&mut page, &settings);
    // The wider range is in force as soon as the board has said that its line is trusted.
    until(
        &mut page,
        "document.querySelector('#settings tr').innerText.includes('mV, 20 to 1500, default 100')",
    );
    assert_eq!(page.value("document.querySelectorAll('#detectors tr').length"), 5);

    page.value(
        "(() => { const input = document.querySelector('#settings input'); input.value = 120; \
         input.dispatchEvent(new Event('change')); return true; })()",
    );
    until(&mut page, "at('log').textContent.includes('> s1-mv = 120 mV') && last.s1_mv === 120");

    // The numbers beside each trace, and what a file has in their place.
    let knobs = "[...document.querySelectorAll('.knobs')].map(row => row.childElementCount > 2).join()";
    until(&mut page, &format!("{knobs} === 'true,true,true,true'"));
    page.value(
        "(() => { const data = new DataTransfer(); data.items.add(new File(['s1-mv = 90\\nblind-ms = 200\\n'], 'a.toml')); \
         at('against').files = data.files; at('against').dispatchEvent(new Event('change')); \
         at('shown').value = 'file'; return true; })()",
    );
    until(
        &mut page,
        "document.querySelectorAll('#settings tr').length === 1 && at('settings').textContent.includes('default 100, file 90')",
    );
    page.value("at('as_file').click()");
    until(&mut page, "last.s1_mv === 90 && at('as_file').hidden");
    page.value("at('undo').click()");
    until(&mut page, "last.s1_mv === 120");

    // What is drawn is of now: traces of the board, and of the truth in its own colour.
    until(
        &mut page,
        "!at('scene').hidden && last.truth.now.needed_n > 0 && at('truth').textContent.includes('kept')",
    );
    until(&mut page, "points[points.length - 1][0] > 8");
    for plot in ["vibration", "ratio", "load"] {
        assert!(points(&mut page, plot, [0x6c, 0xc7, 0xe0]) > 300, "{plot} is drawn");
    }
    assert!(points(&mut page, "load", [0x63, 0xc1, 0x78]) > 100, "the needed force");
    assert!(points(&mut page, "ratio", [0xd8, 0x57, 0x4a]) > 300, "the threshold");
    let apart = page.value("Math.abs(last.truth.now.t_s - last.t_s)").as_f64().unwrap();
    assert!(apart < 0.5, "truth and board are {apart} s apart");

    page.value("at('vibration').dispatchEvent(new WheelEvent('wheel', { deltaY: -1, cancelable: true }))");
    assert_eq!(page.value("span"), 8);
    until(&mut page, "last.rates !== null");
    let (cpu_s, began) = (web.cpu_s(), Instant::now());
    thread::sleep(Duration::from_secs(5));
    let part = (web.cpu_s() - cpu_s) / began.elapsed().as_secs_f64();
    println!("the page's server takes {:.1} % of a core", 100.0 * part);
    assert!(part <= 0.05, "{part}");
    assert_eq!(page.value("[last.missed, last.bad_frames, last.dropped].join()"), "0,0,0");
    let rates = page.value("last.rates");
    assert!((1_500.0..2_500.0).contains(&rates[0].as_f64().unwrap()), "{rates}");
    page.picture("");

    page.value("at('pause').click()");
    let paused = page.value("at('time').textContent");
    thread::sleep(Duration::from_millis(400));
    assert_eq!(page.value("at('time').textContent"), paused);
    page.value("at('pause').click()");
    until(&mut page, &format!("at('time').textContent !== {paused}"));

    served.kill();
    until(&mut page, "at('gone').textContent.includes('no line, trying again')");
    assert!(page.errors.is_empty(), "{:?}", page.errors);
}

#[test]
#[cfg_attr(not(chromium), ignore = "no Chromium here: TENAX_CHROMIUM names one that is not on PATH")]
fn a_person_tests_the_wires_and_grips_at_the_bench_in_the_page() {
    let bench = include_str!("../../../scenes/parts/bench.toml");
    let dead = "\n[[fault]]\nat_s = 0\nchannel = \"fsr_b\"\nkind = \"dead\"\nreason = \"a test\"\n";
    let mut served = Serving::start_telling(&format!("{bench}{dead}"));
    let web = Web::watching(&served.places[0], &["--control", "--truth", &served.places[1]]);
    let mut page = Page::open(&web.url);
    until(
        &mut page,
        "at('keys').childElementCount === 8 && !at('keys').firstChild.disabled && points.length > 40",
    );

    page.value("(() => { at('of').value = 'fsr'; at('start').click(); return true; })()");
    until(&mut page, "at('prompt').textContent.startsWith('press fsr_a (') && !at('touch').hidden");
    page.value("at('touch').click()");
    until(&mut page, "at('level').value > 1 && at('levels').textContent.includes('a touch is')");
    page.picture("-touched");
    page.size(390, 844);
    until(&mut page, "at('prompt').getBoundingClientRect().bottom < innerHeight");
    page.picture("-390-touched");
    page.size(1_280, 900);
    until(&mut page, "at('verdict').className === 'good' && at('verdict').textContent.startsWith('pass, ')");
    until(&mut page, "at('prompt').textContent.startsWith('press fsr_c (') && !at('skip').hidden");
    page.value("at('skip').click()");
    until(&mut page, "at('prompt').textContent.startsWith('press fsr_d (')");
    page.value("at('touch').click()");
    until(
        &mut page,
        "at('prompt').textContent === '2 of 4 channels pass' && at('prompt').className === 'bad'",
    );
    assert!(
        page.value("at('lines').textContent")
            .as_str()
            .unwrap()
            .contains("fsr_b (switch A, 13): 0 mV: a cut wire")
    );
    assert_eq!(
        page.value("[...at('results').children].map(span => span.className).join()"),
        "good,bad,off,good"
    );

    // A key is a button's; typed into a field it is not.
    page.value("document.body.dispatchEvent(new KeyboardEvent('keydown', { key: 'g', bubbles: true }))");
    page.value("at('of').dispatchEvent(new KeyboardEvent('keydown', { key: 'w', bubbles: true }))");
    until(&mut page, "last.truth.now.needed_n > 0 && at('truth').textContent.includes('kept')");
    page.value("[...at('keys').children].find(button => button.textContent === 'p: pull').click()");
    until(&mut page, "at('log').textContent.includes('at the bench: p')");
    assert_eq!(page.value("at('log').textContent.includes('at the bench: w')"), false);
    for (width, height) in [(1_280, 900), (390, 844)] {
        page.size(width, height);
        until(&mut page, &format!("innerWidth === {width} && at('load').width === at('load').clientWidth"));
        assert_eq!(
            page.value("document.documentElement.scrollWidth <= innerWidth"),
            true,
            "nothing is cut at {width}"
        );
        page.picture(&format!("-{width}"));
        page.value("at('lines').scrollIntoView({ block: 'end' })");
        page.picture(&format!("-{width}-test"));
        page.value("scrollTo(0, 0)");
    }

    page.value("at('stop').click()");
    until(&mut page, "at('test').hidden");
    served.kill();
    until(&mut page, "at('bench').hidden");
    assert!(page.errors.is_empty(), "{:?}", page.errors);
}
