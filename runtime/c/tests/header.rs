//! The committed header is the one that the sources give.

use std::path::Path;

fn generated() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml")).unwrap();
    let builder = cbindgen::Builder::new().with_config(config);
    let builder = [
        "src/types.rs",
        "src/ffi.rs",
        "src/admission.rs",
        "src/slots.rs",
        "src/flash.rs",
        "src/supervised.rs",
        "src/keep.rs",
        "src/integers.rs",
        "src/presliding.rs",
    ]
    .into_iter()
    .fold(builder, |builder, file| builder.with_src(folder.join(file)));
    let bindings = builder.generate().unwrap();
    let mut text = Vec::new();
    bindings.write(&mut text);
    String::from_utf8(text).unwrap()
}

#[test]
fn the_header_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("include/frikan.h");
    let header = generated();
    if std::env::var_os("FRIKAN_WRITE_HEADER").is_some() {
        std::fs::write(&path, &header).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == header, "run FRIKAN_WRITE_HEADER=1 cargo test -p frikan-c --test header");
}
