use super::*;
use crate::authentication::{Key, release_block};
use crate::image::encode;
use std::vec::Vec;

const TABLE: &[u8] = include_bytes!("../../../../fixtures/stribeck.frk");
const FORMULA: &[u8] = include_bytes!("../../../../fixtures/elbow.frk");
const KEY: Key = Key::new([5; 32]);

fn tagged(image: &[u8], release: Option<u32>) -> Vec<u8> {
    let mut bytes = image.to_vec();
    bytes.extend(release.iter().flat_map(|number| release_block(*number)));
    bytes.extend(KEY.tag(&bytes));
    bytes
}

/// What the table and the decoded image say to the same demands.
fn both(bytes: &[u8], admission: &Admission<'_>) -> Result<(), ImageError> {
    let decoded = admission.decode::<128>(bytes).map(|_| ());
    assert_eq!(admission.table(bytes).map(|_| ()), decoded);
    decoded
}

#[test]
fn an_image_has_to_be_what_the_firmware_asks_for() {
    let mut image = decode::<128>(TABLE).unwrap();
    let joint = "elbow";
    image.provenance.joint = joint.try_into().unwrap();
    let mut buffer = [0; 4096];
    let bytes = encode(&image, &mut buffer).unwrap();
    let asked = |demands| both(bytes, &Admission { trust: Trust::Anyone, demands });
    let fitting = Demands {
        joint: Some(joint.as_bytes()),
        output_unit: Some(Unit::NewtonMetre),
        channels: Channels::VELOCITY,
        least_release: 0,
    };
    assert_eq!((asked(Demands::NONE), asked(fitting)), (Ok(()), Ok(())));
    for other in [&b"another"[..], b"", b"elbo"] {
        assert_eq!(asked(Demands { joint: Some(other), ..fitting }), Err(ImageError::OtherJoint));
    }
    assert_eq!(asked(Demands { output_unit: Some(Unit::Ampere), ..fitting }), Err(ImageError::OtherUnit));
    assert_eq!(asked(Demands { channels: Channels::POSITION, ..fitting }), Err(ImageError::MissingChannel));
    // Nobody has numbered an image without a tag.
    assert_eq!(asked(Demands { least_release: 1, ..fitting }), Err(ImageError::Outdated));
    let channels = decode::<128>(FORMULA).unwrap().facts(0).channels;
    assert!(channels.hold(Channels::VELOCITY) && !channels.hold(Channels::OTHER));
    assert_eq!(Channels::of_bits(0xFF), Channels::ALL);
}

#[test]
fn an_older_release_is_refused_and_no_number_can_be_forged() {
    let asked = |bytes: &[u8], least_release| {
        both(bytes, &Admission { trust: Trust::Key(&KEY), demands: Demands { least_release, ..Demands::NONE } })
    };
    let seventh = tagged(TABLE, Some(7));
    assert_eq!([0, 7].map(|least| asked(&seventh, least)), [Ok(()); 2]);
    assert_eq!(asked(&seventh, 8), Err(ImageError::Outdated));
    // Tags without a number are of release 0.
    let unnumbered = tagged(TABLE, None);
    assert_eq!((asked(&unnumbered, 0), asked(&unnumbered, 1)), (Ok(()), Err(ImageError::Outdated)));
    for byte in TABLE.len()..TABLE.len() + 8 {
        let mut forged = seventh.clone();
        forged[byte] ^= 0x08;
        assert_eq!(asked(&forged, 0), Err(ImageError::NotAuthentic));
    }
    // A number that is put in or left out.
    let old_tag = &unnumbered[TABLE.len()..];
    assert_eq!(asked(&[TABLE, &release_block(9), old_tag].concat(), 0), Err(ImageError::NotAuthentic));
    assert_eq!(asked(&[TABLE, &seventh[TABLE.len() + 8..]].concat(), 0), Err(ImageError::NotAuthentic));
    // In flash, before whatever lies behind.
    for image in [&seventh, &unnumbered] {
        let flash = [&image[..], &[0xFF; 64]].concat();
        assert_eq!(Trust::Key(&KEY).stored(&flash), Ok(&image[..]));
    }
    // A drive without a key takes neither number nor tag for an image.
    assert_eq!(both(&seventh, &Admission::ANY), Err(ImageError::TrailingBytes));
}
