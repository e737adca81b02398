fn main() {
    tenax_studies::evaluate::emg::diagnose(std::path::Path::new(&std::env::args().nth(1).unwrap()));
}
