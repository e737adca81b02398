//! probe
use tenax_bench::hand::report;
use tenax_bench::session::load_scene;
#[test]
fn probe() {
    for name in ["pinch","ball","bottle","ice"] {
        let s = report::scene(&load_scene(name).unwrap(), 1..9);
        println!("{}", report::Report{scenes: vec![s], cuts: None});
    }
}
