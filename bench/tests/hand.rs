//! probe
use tenax_bench::hand::{run, Options};
use tenax_bench::session::load_scene;
#[test]
fn probe() {
    for name in ["pinch","ball","bottle","ice"] {
        for palm in [false,true] {
            let t=std::time::Instant::now();
            let o = run(&load_scene(name).unwrap(), &Options{palm,..Options::default()}, None);
            let n=o.sums.len();
            let mean=|f:&dyn Fn(&tenax_bench::hand::Sum)->Option<f64>|{let v:Vec<f64>=o.sums.iter().filter_map(|s|f(s)).collect(); v.iter().sum::<f64>()/v.len().max(1) as f64};
            println!("{name} palm {palm}: dropped {} slid {:.2} opened {} driven {} pulses {} peak {:.1} mean {:.2} least {:.2} known {:.2} n {n} end {:?}", o.dropped,o.slid_mm,o.opened,o.driven,o.pulses,o.peak_n, mean(&|s|Some(s.pressed_n)),mean(&|s|s.least_n),mean(&|s|s.known_n), o.end_n);
            println!("   evidence {:?} said {:?} untold {} clock {} cycle {} {} lines {:?} lost {} reports {:?} {:.1} s wall", o.evidence_s,o.said_s,o.untold,o.clock_us,o.cycle_us,o.cycles,o.lines,o.line_dropped,&o.reports[..o.reports.len().min(20)],t.elapsed().as_secs_f64());
        }
    }
}
