//! The linked firmware of every target: no panic, no unwinding, no allocation.

use frikan_trainer::emulator::{Firmware, forbidden_symbols};

/// That a panic can be reached is a link error already (the panic handler calls a function that nobody defines); this
/// looks at the result.
#[test]
fn no_firmware_holds_a_panic_or_an_allocator() {
    let firmware = Firmware::find().unwrap();
    let names = firmware.target_names().unwrap();
    assert!(names.len() >= 6, "{names:?}");
    for name in names {
        let target = firmware.target(&name).unwrap();
        for binary in ["drive", "emulate", "emulate-step"] {
            let found = forbidden_symbols(&firmware.build(&target, binary).unwrap()).unwrap();
            assert!(found.is_empty(), "{binary} of {name}: {found:?}");
        }
    }
}

/// The scan sees what it looks for: this test program holds panics.
#[test]
fn the_scan_finds_panics() {
    let found = forbidden_symbols(&std::env::current_exe().unwrap()).unwrap();
    assert!(found.iter().any(|name| name.contains("panicking")), "{} symbols", found.len());
}
