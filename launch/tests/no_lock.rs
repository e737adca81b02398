//! What is built is started without Cargo, which would wait for another build's lock.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;
use std::time::SystemTime;

use tenax_launch::tool::Tool;

#[test]
fn a_tool_that_is_built_is_started_where_no_cargo_is() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let target = std::env::temp_dir().join(format!("tenax-no-lock-{}", std::process::id()));
    ["launch", "release"].iter().for_each(|folder| fs::create_dir_all(target.join(folder)).unwrap());
    let launcher = target.join("launch/tenax-launch");
    fs::copy(env!("CARGO_BIN_EXE_tenax-launch"), &launcher).unwrap();
    let started = |arguments: &[&str]| {
        let output = Command::new(&launcher).args(arguments).env("PATH", "").output().unwrap();
        [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap())
    };
    let make = |tool: Tool| {
        let program = tool.program(root, &target);
        fs::write(&program.file, format!("#!/bin/sh\necho {tool:?} \"$@\"\n")).unwrap();
        fs::set_permissions(&program.file, fs::Permissions::from_mode(0o755)).unwrap();
        let list = format!("{}: {}/launch/src/main.rs\n", program.file.display(), root.display());
        fs::write(program.file.with_extension("d"), list).unwrap();
        program.built(SystemTime::now()).unwrap();
    };

    let [said, error] = started(&["monitor", "--plain"]);
    assert!(said.is_empty() && error.contains("cannot start cargo"), "{said}{error}");
    // Where only the whole tool is built, nobody waits for the smaller one.
    make(Tool::Whole);
    assert_eq!(started(&["monitor", "--plain"])[0], "Whole monitor --plain\n");
    make(Tool::Serial);
    assert_eq!(started(&["monitor", "--plain"])[0], "Serial monitor --plain\n");
    assert_eq!(started(&["scenes"])[0], "Whole scenes\n");
    fs::remove_dir_all(&target).unwrap();
}
