//! Golden images: what an earlier trainer wrote, every later runtime reads and evaluates to the same bits.

use frikan_shared::image::checksum;
use frikan_tests::fixtures::{folder, output_bits};
use frikan_trainer::fit::model;

/// CRC-32 of the bits that each gave when it was written.
#[test]
fn images_of_earlier_formats_keep_their_bits() {
    let older = [
        ("stribeck-3", 0xc0a5_b5b7),
        ("elbow-3", 0xf343_024f),
        ("stribeck-4", 0xc0a5_b5b7),
        ("elbow-4", 0xf343_024f),
        ("stribeck-5", 0xf64d_2bed),
        ("elbow-5", 0x643c_74a1),
    ];
    for (name, bits) in older {
        let (_, image) = model::load(&folder().join("older").join(name).with_extension("frk")).unwrap();
        assert_eq!(checksum(&[output_bits(&image.model).as_bytes()]), bits, "{name}: outputs have changed");
    }
}

#[test]
fn golden_images_keep_their_bits() {
    for name in ["elbow", "stribeck", "integers"] {
        let (bytes, image) = model::load(&folder().join(name).with_extension("frk")).unwrap();
        let expected = std::fs::read_to_string(folder().join(name).with_extension("bits")).unwrap();
        assert!(output_bits(&image.model) == expected, "{name}: outputs have changed");
        assert!(model::to_bytes(&image).unwrap() == bytes, "{name}: encoding has changed");
    }
}
