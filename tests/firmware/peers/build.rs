//! Compiles the C peers as a drive's firmware would, and links them with newlib.

use std::path::PathBuf;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=c/friction.c");
    println!("cargo::rerun-if-changed=../targets");
    let mut build = cc::Build::new();
    build.file("c/friction.c").opt_level(2).warnings(true).flag("-mcpu=cortex-m4").flag("-ffunction-sections");
    build.compile("friction");

    let compiler = build.get_compiler();
    for library in ["m", "c", "gcc"] {
        let mut command = Command::new(compiler.path());
        command.args(["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"]);
        let output = command.arg(format!("-print-file-name=lib{library}.a")).output().expect("the C compiler runs");
        let path = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
        let folder = path.parent().expect("newlib is installed");
        println!("cargo::rustc-link-search=native={}", folder.display());
        println!("cargo::rustc-link-lib=static={library}");
    }
}
