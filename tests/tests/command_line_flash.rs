//! The command line around flash: every form of export, and dumps read back.

use std::path::Path;
use std::process::Command;

use frikan_tests::c::host_program;
use frikan_tests::command::{Run, run};
use frikan_tests::fixtures::folder;

const KEY: &str = "000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f\n";

/// A folder with the golden images and two keys.
fn bench() -> tempfile::TempDir {
    let bench = tempfile::tempdir().unwrap();
    for name in ["elbow.frk", "stribeck.frk"] {
        std::fs::copy(folder().join(name), bench.path().join(name)).unwrap();
    }
    std::fs::write(bench.path().join("drive.key"), KEY).unwrap();
    std::fs::write(bench.path().join("other.key"), KEY.replace("1f", "1e")).unwrap();
    std::fs::write(bench.path().join("bad.key"), "secret").unwrap();
    bench
}

fn export(at: &Path, form: &str, file: &str, options: &[&str]) -> Run {
    run(at, &[&["export", "stribeck.frk", "--to", form, "-o", file], options].concat())
}

#[test]
fn every_form_holds_the_very_bytes() {
    let bench = bench();
    let at = bench.path();
    let image = std::fs::read(at.join("stribeck.frk")).unwrap();
    let address = ["--address", "0x08060000"];

    let bin = export(at, "bin", "m.bin", &address);
    assert_eq!(bin.status, 0, "{}", bin.messages);
    assert!(std::fs::read(at.join("m.bin")).unwrap() == image);
    assert!(bin.output.contains("probe-rs download") && bin.output.contains("openocd"), "{}", bin.output);
    assert!(bin.output.contains("0x08060000") && bin.output.contains("m.bin"), "{}", bin.output);

    let hex = export(at, "hex", "m.hex", &address);
    assert!(hex.output.contains("--binary-format hex"), "{}", hex.output);
    let text = std::fs::read_to_string(at.join("m.hex")).unwrap();
    let data = text
        .lines()
        .filter(|line| &line[7..9] == "00")
        .flat_map(|line| (9..line.len() - 2).step_by(2).map(|at| u8::from_str_radix(&line[at..at + 2], 16).unwrap()));
    assert!(data.collect::<Vec<u8>>() == image && text.starts_with(":020000040806EC\n"));

    assert_eq!(export(at, "uf2", "m.uf2", &["--address", "0x10000000", "--family", "0xe48bff56"]).status, 0);
    let blocks = std::fs::read(at.join("m.uf2")).unwrap();
    let data: Vec<u8> = blocks.chunks(512).flat_map(|block| block[32..288].to_vec()).collect();
    assert!(data[..image.len()] == image);

    assert_eq!(export(at, "c-header", "m.h", &[]).status, 0);
    let main = at.join("main.c");
    std::fs::write(&main, "#include \"m.h\"\n#include <stdio.h>\nint main(void) { return fwrite(m_image, M_IMAGE_BYTES, 1, stdout) != 1; }\n").unwrap();
    host_program(&[main], &at.join("array"));
    assert!(Command::new(at.join("array")).output().unwrap().stdout == image);

    // To standard output nothing but the form goes.
    let hex = run(at, &["export", "stribeck.frk", "--to", "hex", "--address", "0", "-o", "-"]);
    assert!(hex.output.lines().all(|line| line.starts_with(':')) && hex.status == 0);
}

/// An address that is missing, wraps or lies within a page, and a family that is missing, are refused and nothing is written.
#[test]
fn a_place_that_is_none_is_refused() {
    let bench = bench();
    let at = bench.path();
    let family = ["--family", "0xe48bff56"];
    let refused: [(&str, &[&str]); 8] = [
        ("hex", &[]),
        ("hex", &["--address", "0xFFFFFFF0"]),
        ("bin", &["--address", "0xFFFFFFF0"]),
        ("uf2", &family),
        ("uf2", &["--address", "0x10000000"]),
        ("uf2", &["--address", "0x10000080", family[0], family[1]]),
        ("uf2", &["--address", "0xFFFFFF00", family[0], family[1]]),
        ("uf2", &["--address", "0x10000001", family[0], family[1]]),
    ];
    for (form, options) in refused {
        let refusal = export(at, form, "m.out", options);
        assert_eq!(refusal.status, 2, "{form} {options:?}: {}", refusal.output);
        assert!(refusal.messages.contains("FRK-U001"), "{form} {options:?}: {}", refusal.messages);
        assert!(!at.join("m.out").exists(), "{form} {options:?}");
    }
}

/// The object links for its processor, where the linker script puts it, under its symbol.
#[test]
fn the_object_file_links() {
    let bench = bench();
    let at = bench.path();
    let image = std::fs::read(at.join("stribeck.frk")).unwrap();
    assert_eq!(export(at, "elf", "m.o", &[]).status, 0);
    assert_eq!(run(at, &["export", "elbow.frk", "--to", "elf", "-o", "n.o"]).status, 0);
    std::fs::write(
        at.join("m.c"),
        "extern const unsigned char m_image[], n_image[];\nconst void *entry(int n) { return n ? n_image : m_image; }\n",
    )
    .unwrap();
    std::fs::write(
        at.join("m.ld"),
        "ENTRY(entry)\nSECTIONS { .text 0x100 : { *(.text*) } .frikan 0x08060000 : { KEEP(m.o(.frikan)) } .other : { KEEP(n.o(.frikan)) } }\n",
    )
    .unwrap();
    let processor = ["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"];
    let tool = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).current_dir(at).args(arguments).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    tool(
        "arm-none-eabi-gcc",
        &[&processor[..], &["-nostdlib", "-Wl,--gc-sections", "m.c", "m.o", "n.o", "-T", "m.ld", "-o", "m.elf"]]
            .concat(),
    );
    tool("arm-none-eabi-objcopy", &["-O", "binary", "--only-section=.frikan", "m.elf", "m.section"]);
    assert!(std::fs::read(at.join("m.section")).unwrap() == image);
    assert!(tool("arm-none-eabi-nm", &["m.elf"]).contains("08060000 R m_image"));
}

/// Header and image in flash words of their own, the last one filled with erased bytes.
#[test]
fn a_slot_is_laid_out_as_its_flash_is_written() {
    let bench = bench();
    let at = bench.path();
    let image = std::fs::read(at.join("stribeck.frk")).unwrap();
    let flash = ["--slot", "9", "--program-unit", "32", "--erase-size", "0x20000", "--erased", "0x00"];
    let done = export(at, "bin", "m.bin", &[&flash[..], &["--address", "0x08060000"]].concat());
    assert_eq!(done.status, 0, "{}", done.messages);
    let slot = std::fs::read(at.join("m.bin")).unwrap();
    let (header, rest) = slot.split_at(32);
    assert!(slot.len().is_multiple_of(32) && header[..4] == *b"FSLT" && header[16..].iter().all(|byte| *byte == 0));
    assert!(rest[..image.len()] == image && rest[image.len()..].iter().all(|byte| *byte == 0));
    let shown = run(at, &["show", "m.bin", "--compare", "stribeck.frk"]);
    assert!(shown.status == 0 && shown.output.contains("sequence 9"), "{}", shown.output);
    for options in [
        &["--slot", "9", "--program-unit", "3"][..],
        &["--slot", "9", "--program-unit", "64"],
        &["--slot", "9", "--program-unit", "32", "--erase-size", "48"],
        &["--slot", "9", "--erase-size", "0"],
        &["--slot", "9", "--erased", "0x55"],
        &["--slot", "9", "--erased", "256"],
        &["--slot", "9", "--erase-size", "2048", "--address", "0x08060400"],
        &["--program-unit", "8"],
    ] {
        let refused = export(at, "bin", "n.bin", options);
        assert!(refused.status == 2 && refused.messages.contains("FRK-U001"), "{options:?}: {}", refused.messages);
    }
    assert!(!at.join("n.bin").exists());
}

#[test]
fn a_dump_is_told_from_another() {
    let bench = bench();
    let at = bench.path();
    for (slot, file) in [("7", "7.bin"), ("8", "8.bin")] {
        let options = ["--slot", slot, "--key-file", "drive.key", "--release", slot];
        assert_eq!(export(at, "bin", file, &options).status, 0);
    }
    let elbow = run(at, &["export", "elbow.frk", "--to", "bin", "--slot", "6", "-o", "6.bin"]);
    assert_eq!(elbow.status, 0, "{}", elbow.messages);
    let slot = |file: &str| {
        let mut bytes = std::fs::read(at.join(file)).unwrap();
        bytes.resize(4096, 0xFF);
        bytes
    };
    let write = |name: &str, bytes: Vec<u8>| std::fs::write(at.join(name), bytes).unwrap();
    let show = |arguments: &[&str]| run(at, &[&["show"], arguments].concat());

    write("dump.bin", [slot("6.bin"), slot("7.bin")].concat());
    let same = show(&["dump.bin", "--compare", "stribeck.frk", "--key-file", "drive.key"]);
    assert_eq!(same.status, 0, "{}", same.messages);
    assert!(
        same.output.contains("sequence 7")
            && same.output.contains("release 7")
            && same.output.contains("this is the image of stribeck.frk"),
        "{}",
        same.output
    );
    let other = show(&["dump.bin", "--compare", "elbow.frk"]);
    assert!(other.status == 1 && other.output.contains("this is NOT the image of elbow.frk"), "{}", other.output);
    // A drive with another key uses none.
    let refused = show(&["dump.bin", "--compare", "stribeck.frk", "--key-file", "other.key"]);
    assert!(refused.status == 1 && refused.output.contains("NOT authentic"), "{}", refused.output);

    // One bit, and the older one is in use.
    let mut damaged = [slot("6.bin"), slot("7.bin")].concat();
    damaged[4096 + 200] ^= 0x10;
    write("damaged.bin", damaged);
    let damaged = show(&["damaged.bin", "--compare", "elbow.frk"]);
    assert!(damaged.status == 0 && damaged.output.contains("refused: the image is damaged"), "{}", damaged.output);

    write("erased.bin", vec![0xFF; 4096]);
    let erased = show(&["erased.bin"]);
    assert!(erased.status == 3 && erased.messages.contains("FRK-D020"), "{}", erased.messages);
    assert_eq!(show(&["stribeck.frk", "--compare", "stribeck.frk"]).status, 0);
}

#[test]
fn a_signature_is_checked_by_the_public_key_alone() {
    let bench = bench();
    let at = bench.path();
    let signed = export(at, "bin", "s.bin", &["--signing-key-file", "drive.key", "--release", "5"]);
    let public_key = signed.messages.trim().strip_prefix("public key ").expect("it is printed").to_owned();
    assert_ne!(public_key.as_str(), KEY.trim());
    std::fs::write(at.join("public.key"), public_key).unwrap();
    let show = |file: &str, key: &str| run(at, &["show", file, "--compare", "stribeck.frk", "--public-key-file", key]);
    let sound = show("s.bin", "public.key");
    assert!(sound.status == 0 && sound.output.contains("authentic, release 5"), "{}", sound.output);
    let mut forged = std::fs::read(at.join("s.bin")).unwrap();
    assert_eq!(forged.len(), std::fs::read(at.join("stribeck.frk")).unwrap().len() + 8 + 64);
    *forged.last_mut().unwrap() ^= 1;
    std::fs::write(at.join("forged.bin"), forged).unwrap();
    for refused in [show("forged.bin", "public.key"), show("stribeck.frk", "public.key"), show("s.bin", "drive.key")] {
        assert!(refused.status == 1 && refused.output.contains("NOT authentic"), "{}", refused.output);
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let bench = bench();
    let at = bench.path();
    for (form, options, status, code) in [
        ("bin", &["--key-file", "bad.key"][..], 3, "FRK-D022"),
        ("bin", &["--key-file", "absent.key"], 5, "FRK-I002"),
        ("json", &["--slot", "1"], 2, "FRK-U001"),
        ("bin", &["--release", "1"], 2, "--key-file"),
        ("bin", &["--key-file", "drive.key", "--signing-key-file", "drive.key"], 2, "cannot be used with"),
        ("c", &["--key-file", "drive.key"], 2, "FRK-U001"),
        ("c", &[], 2, "FRK-U001"),
    ] {
        let refused = export(at, form, "m.out", options);
        assert!(refused.status == status && refused.messages.contains(code), "{form}: {}", refused.messages);
    }
    assert!(!at.join("m.out").exists());
    let c = export(at, "c", "joint.c", &[]);
    assert_eq!((c.status, c.output.as_str()), (0, ""), "{}", c.messages);
    assert!(std::fs::read_to_string(at.join("joint.h")).unwrap().contains("float joint_friction(float velocity);"));
}
