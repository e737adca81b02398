//! A stranger's rows: what his detector said in his own recordings, as CSV.
