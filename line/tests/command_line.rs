//! The tool as it is started: what it says of files that cannot be meant, and what it does when nobody reads.

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::Duration;

fn tenax(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tenax-host"));
    command.args(args).stdin(Stdio::null());
    command
}

fn failed(args: &[&str]) -> String {
    let Output { status, stderr, .. } = tenax(args).output().expect("it starts");
    assert_eq!(status.code(), Some(2), "{args:?}");
    String::from_utf8(stderr).expect("text")
}

/// As `tenax ... | head -1`: one byte is read, then nobody reads.
fn cut_off(args: &[&str]) -> Output {
    let mut child = tenax(args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
    let mut out = child.stdout.take().expect("a pipe");
    out.read_exact(&mut [0]).expect("a byte");
    drop(out);
    child.wait_with_output().expect("it ends")
}

#[test]
fn an_output_that_nobody_reads_is_no_error() {
    for args in [&["scenes"][..], &["wiring"]] {
        let Output { status, stderr, .. } = cut_off(args);
        assert!(status.success(), "{args:?}: {status}");
        assert_eq!(String::from_utf8_lossy(&stderr), "", "{args:?}");
    }
}

#[test]
#[cfg(unix)]
fn a_device_is_no_scene_no_recipe_and_no_recording() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let run = |what: &[&str]| failed(&[&["run", "--host", "--out", out], what].concat());
    assert_eq!(
        run(&["--scene", "/dev/zero"]),
        "error: cannot read /dev/zero: it is longer than 1 MB, the most allowed\n"
    );
    assert_eq!(
        run(&["--replay", "/dev/zero"]),
        "error: /dev/zero:1: longer than 100 kB: no row of a CSV file\n"
    );
    assert_eq!(
        failed(&["evaluate", "--dataset", "/dev/zero", "--recipe", "array"]),
        "error: /dev/zero:1: longer than 100 kB: no row of a CSV file\n"
    );
    assert_eq!(
        failed(&["evaluate", "--dataset", "/dev/null", "--recipe", "/dev/zero"]),
        "error: /dev/zero: cannot be read: it is longer than 1 MB, the most allowed\n"
    );
}

#[test]
fn what_is_missing_or_cannot_be_written_is_said_before_work_begins() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let out = file.path().to_str().unwrap();
    let is_a_file = format!("error: cannot write to the folder {out}: is a file, and a folder is needed\n");
    // The first would take minutes, the second compiles a package.
    assert_eq!(failed(&["chart", "front", "--out", out]), is_a_file);
    assert_eq!(failed(&["train", "--out", out]), is_a_file);
    assert_eq!(failed(&["run", "--host", "--out", out]), is_a_file);
    let folder = tempfile::tempdir().unwrap();
    let train = ["train", "--out", folder.path().to_str().unwrap(), "--recipe", "array", "--dataset"];
    let missing = failed(&[&train[..], &["no/such.csv"]].concat());
    assert!(missing.starts_with("error: no/such.csv: cannot be read"), "{missing}");
    fs::write(file.path(), "a1\n1\n").unwrap();
    let wrong = failed(&[&train[..], &[out]].concat());
    assert!(wrong.contains(":1: no column"), "{wrong}");
}

#[test]
fn what_is_no_boards_line_is_neither_played_nor_watched_nor_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let (empty, random) = (folder.path().join("empty.bin"), folder.path().join("random.bin"));
    fs::write(&empty, "").unwrap();
    fs::write(
        &random,
        (0..100_000_u32).map(|n| (n.wrapping_mul(2_654_435_761) >> 13) as u8).collect::<Vec<u8>>(),
    )
    .unwrap();
    let readme = concat!(env!("CARGO_MANIFEST_DIR"), "/../README.md");
    for file in [readme, empty.to_str().unwrap(), random.to_str().unwrap()] {
        for command in
            [&["play", "--serve-tcp", "0"][..], &["plot"], &["config", "suggest"], &["monitor", "--file"]]
        {
            let said = failed(&[command, &[file]].concat());
            assert!(
                said.contains("is no board's line") && said.contains("tenax record"),
                "{command:?}: {said}"
            );
        }
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_port_that_another_program_reads_names_it() {
    use serialport::{SerialPort, TTYPort};

    let (_near, far) = TTYPort::pair().unwrap();
    let path = far.name().unwrap();
    // Or this program would be the one that is named.
    drop(far);
    let mut other = Command::new("sh")
        .args(["-c", &format!("exec 3<{path}; echo; exec sleep 60")])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    other.stdout.take().unwrap().read_exact(&mut [0]).unwrap();
    let said = failed(&["monitor", "--plain", "--port", &path]);
    assert!(said.contains(&format!("another program reads {path}: process {} (s", other.id())), "{said}");
    other.kill().unwrap();
    other.wait().unwrap();
}

const SWEPT: [&str; 5] = ["sweep", "--scenes", "gripper-control,rig", "--seeds", "1..3"];

/// What a merge of these folders leaves in the first.
fn merged(folders: &[&Path]) -> [Vec<u8>; 2] {
    let output = tenax(&["sweep", "merge"]).args(folders).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert!(
        String::from_utf8_lossy(&output.stdout).starts_with("runs                        6\n"),
        "{output:?}"
    );
    ["runs.jsonl", "summary.json"].map(|name| fs::read(folders[0].join(name)).unwrap())
}

fn is_swept(folder: &Path, shard: &[&str]) -> String {
    let output = tenax(&SWEPT).args(shard).arg("--out").arg(folder).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn a_sweep_gives_the_same_bytes_in_any_shards_and_after_a_kill() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, part, other, killed] =
        ["whole", "part", "other", "killed"].map(|name| folder.path().join(name));
    assert!(is_swept(&whole, &[]).contains("6 runs done now"));
    let all = merged(&[&whole]);
    for of in [3, 16] {
        for number in (1..=of).rev() {
            // As of two machines.
            let out = if number % 2 == 0 { &part } else { &other };
            is_swept(out, &["--shard", &format!("{number}/{of}")]);
        }
        assert_eq!(merged(&[&part, &other]), all, "{of} shards");
        fs::remove_dir_all(&part).unwrap();
        fs::remove_dir_all(&other).unwrap();
    }

    let runs = || {
        let names = fs::read_dir(&killed).into_iter().flatten().map(|entry| entry.unwrap().path());
        names
            .filter(|path| path.to_str().unwrap().ends_with(".json") && !path.ends_with("plan.json"))
            .collect::<Vec<_>>()
    };
    let mut child = tenax(&SWEPT).arg("--out").arg(&killed).stderr(Stdio::null()).spawn().unwrap();
    while runs().is_empty() && child.try_wait().unwrap().is_none() {
        thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let done = runs();
    let cut = fs::read(&done[0]).unwrap();
    fs::write(&done[0], &cut[..cut.len() - 2]).unwrap();
    let missing = failed(&["sweep", "merge", killed.to_str().unwrap()]);
    assert!(missing.starts_with(&format!("error: {} of 6 runs are missing: ", 7 - done.len())), "{missing}");
    assert!(is_swept(&killed, &[]).contains(&format!("{} runs done now", 7 - done.len())));
    assert_eq!(merged(&[&killed]), all);

    let others = failed(&["sweep", "--seeds", "4", "--out", whole.to_str().unwrap()]);
    assert!(others.contains("holds another sweep"), "{others}");
}
