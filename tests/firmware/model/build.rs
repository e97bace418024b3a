//! Links again when the memory of a target changes.

fn main() {
    println!("cargo::rerun-if-changed=../targets");
}
