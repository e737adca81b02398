// Part of several build scripts: whether the recordings of others are here, so that a test of them is counted as ignored where they
// are not: `#[cfg_attr(not(recordings), ignore = "no recordings in ../shared/data")]`, and the same of `videos`.

/// Sets `recordings` and `videos`. They are never part of the project, but lie beside it.
fn recordings() {
    println!("cargo::rustc-check-cfg=cfg(recordings, videos)");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=../sim/recordings.rs");
    let readme = std::path::Path::new("../../shared/data/README.md");
    // A file that is not there would have every build begin with this script.
    if !readme.exists() {
        return;
    }
    println!("cargo::rerun-if-changed={}", readme.display());
    println!("cargo::rustc-cfg=recordings");
    let ffmpeg = std::process::Command::new("ffmpeg").arg("-version").output().is_ok();
    let video = readme.with_file_name("fingervision/skin_video_54fps.m4v").exists();
    if ffmpeg && video {
        println!("cargo::rustc-cfg=videos");
    }
}
