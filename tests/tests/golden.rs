//! Golden images: what an earlier trainer wrote, every later runtime reads and evaluates to the same bits.

use frikan_tests::fixtures::{folder, output_bits};
use frikan_trainer::fit::model;

#[test]
fn golden_images_keep_their_bits() {
    for name in ["elbow", "stribeck"] {
        let (bytes, image) = model::load(&folder().join(name).with_extension("frk")).unwrap();
        let expected = std::fs::read_to_string(folder().join(name).with_extension("bits")).unwrap();
        assert!(output_bits(&image.model) == expected, "{name}: outputs have changed");
        assert!(model::to_bytes(&image).unwrap() == bytes, "{name}: encoding has changed");
    }
}
