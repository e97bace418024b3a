//! How an exported file gets into the drive: the commands of probe-rs, OpenOCD, picotool and esptool, for the user to run.

/// What an exported file says of itself to a flash tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Addressing {
    /// Bytes without an address.
    None,
    /// The file holds its addresses.
    Inside,
}

/// The commands that write `file` to `address` and read `bytes` bytes back into a dump. What is not known is left for the user to
/// fill in, in capitals.
#[must_use]
pub fn commands(file: &str, address: Option<u32>, bytes: usize, addressing: Addressing, chip: Option<&str>) -> String {
    let lower = chip.unwrap_or_default().to_ascii_lowercase();
    if lower.starts_with("rp2") {
        return of_pico(file, address, addressing);
    }
    if lower.starts_with("esp") && addressing == Addressing::None {
        return of_esp(file, address, bytes, &lower);
    }
    let (file, chip) = (quoted(file), quoted(chip.unwrap_or("CHIP")));
    let address = address.map_or_else(|| "ADDRESS".to_owned(), |address| format!("{address:#010x}"));
    let (format, place) = match addressing {
        Addressing::None => (format!("bin --base-address {address}"), format!(" {address}")),
        Addressing::Inside => ("hex".to_owned(), String::new()),
    };
    format!(
        "probe-rs download --chip {chip} --binary-format {format} --verify {file}\n\
         openocd -f board.cfg -c \"program {file} verify reset exit{place}\"\n\
         openocd -f board.cfg -c \"init; halt; dump_image dump.bin {address} {bytes}; resume; exit\"\n"
    )
}

/// The commands for a chip of Raspberry Pi, by its boot loader.
fn of_pico(file: &str, address: Option<u32>, addressing: Addressing) -> String {
    let place = match (addressing, address) {
        (Addressing::Inside, _) => String::new(),
        (Addressing::None, None) => " -o ADDRESS".to_owned(),
        (Addressing::None, Some(address)) => format!(" -o {address:#010x}"),
    };
    format!("picotool load -v {}{place}\npicotool reboot\n", quoted(file))
}

/// The commands for a chip of Espressif, by its boot loader; `chip` as probe-rs names it, in small letters. Addresses are those in flash, from 0 on.
fn of_esp(file: &str, address: Option<u32>, bytes: usize, chip: &str) -> String {
    let address = address.map_or_else(|| "ADDRESS".to_owned(), |address| format!("{address:#x}"));
    format!(
        "esptool.py --chip {chip} write_flash {address} {}\n\
         esptool.py --chip {chip} read_flash {address} {bytes} dump.bin\n",
        quoted(file)
    )
}

/// A name as a shell and OpenOCD take it.
fn quoted(name: &str) -> String {
    let plain = |character: char| character.is_ascii_alphanumeric() || "._-/".contains(character);
    if name.chars().all(plain) { name.to_owned() } else { format!("'{}'", name.replace('\'', "'\\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_binary_needs_its_address_and_hex_does_not() {
        let binary = commands("elbow.bin", Some(0x0806_0000), 113, Addressing::None, Some("STM32G474RETx"));
        assert!(
            binary.contains("probe-rs download --chip STM32G474RETx --binary-format bin --base-address 0x08060000")
        );
        assert!(binary.contains("program elbow.bin verify reset exit 0x08060000"));
        assert!(binary.contains("dump_image dump.bin 0x08060000 113"));
        let hex = commands("my elbow.hex", None, 113, Addressing::Inside, None);
        assert!(hex.contains("--binary-format hex --verify 'my elbow.hex'") && hex.contains("verify reset exit\""));
        assert!(hex.contains("--chip CHIP") && hex.contains("dump_image dump.bin ADDRESS 113"));
    }

    #[test]
    fn chips_with_a_boot_loader_of_their_own_have_their_own_tool() {
        let pico = |addressing| commands("elbow.bin", Some(0x1018_0000), 113, addressing, Some("RP2040"));
        assert_eq!(pico(Addressing::None), "picotool load -v elbow.bin -o 0x10180000\npicotool reboot\n");
        assert!(pico(Addressing::Inside).starts_with("picotool load -v elbow.bin\n"));
        let esp = commands("elbow.bin", Some(0x11_0000), 113, Addressing::None, Some("ESP32C3"));
        assert!(esp.contains("esptool.py --chip esp32c3 write_flash 0x110000 elbow.bin\n"), "{esp}");
        assert!(esp.contains("read_flash 0x110000 113 dump.bin"));
    }
}
