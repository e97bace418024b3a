//! What flash holds: finds the images in a dump, wherever they begin, with their slots and tags.

use frikan_runtime::slots::{SLOT_HEADER_BYTES, valid_slots};
use frikan_shared::authentication::Trust;
use frikan_shared::image::{Image, ImageError, MAGIC, decode};

use crate::fit::CELLS;

/// Bytes from the header of a slot to its image: at once, or in the next program unit where that has more bytes.
const HEADER_OFFSETS: [usize; 2] = [SLOT_HEADER_BYTES, 32];

/// A place at which an image begins.
#[derive(Debug)]
pub struct Found<'a> {
    /// Bytes from the start of the dump.
    pub offset: usize,
    /// Sequence number of the slot around it, where the slot is intact.
    pub sequence: Option<u32>,
    /// The image's bytes and content, or why it is none.
    pub image: Result<(&'a [u8], Box<Image<CELLS>>), ImageError>,
    /// Whether the tag or the signature that is asked for stands behind it, where one is.
    pub authentic: Option<bool>,
    /// Number of the release, where the tag says so; 0 for none.
    pub release: u32,
}

impl Found<'_> {
    /// Whether a drive with this key, or without, can use it.
    #[must_use]
    pub fn is_usable(&self) -> bool {
        self.image.is_ok() && self.authentic != Some(false)
    }
}

/// Every image in `dump`, in the order of addresses; `trust` is that of a drive which asks for a tag or a signature.
#[must_use]
pub fn images<'a>(dump: &'a [u8], trust: Option<Trust<'_>>) -> Vec<Found<'a>> {
    let starts = (0..dump.len()).filter(|&offset| dump[offset..].starts_with(&MAGIC));
    let found = |offset: usize| {
        let stored = Trust::Anyone.stored(&dump[offset..]);
        let image = stored.and_then(|bytes| Ok((bytes, Box::new(decode(bytes)?))));
        let sequence = HEADER_OFFSETS.into_iter().find_map(|before| {
            let header = dump.get(offset.checked_sub(before)?..)?.get(..SLOT_HEADER_BYTES)?;
            valid_slots(&[header, &dump[offset..]].concat(), &[])[0].map(|slot| slot.sequence)
        });
        let released = trust.map(|trust| {
            let (image, release) = trust.stored(&dump[offset..]).and_then(|bytes| trust.released(bytes))?;
            decode::<CELLS>(image).map(|_| release)
        });
        Found {
            offset,
            sequence,
            image,
            authentic: released.map(|released| released.is_ok()),
            release: released.and_then(Result::ok).unwrap_or(0),
        }
    };
    starts.map(found).collect()
}

/// The one that the drive uses: the usable one in the newest slot, or the first usable one where there are no slots.
#[must_use]
pub fn in_use<'a, 'b>(found: &'b [Found<'a>]) -> Option<&'b Found<'a>> {
    let later = |a: u32, b: u32| (b.wrapping_sub(a) as i32) > 0;
    found.iter().filter(|image| image.is_usable()).reduce(|newest, other| match (newest.sequence, other.sequence) {
        (Some(a), Some(b)) if later(a, b) => other,
        (None, Some(_)) => other,
        _ => newest,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use frikan_runtime::slots::slot_header;
    use frikan_shared::authentication::{Key, release_block};

    const KEY: Key = Key::new([3; 32]);

    fn golden(name: &str) -> Vec<u8> {
        std::fs::read(format!("{}/../fixtures/{name}.frk", env!("CARGO_MANIFEST_DIR"))).unwrap()
    }

    #[test]
    fn the_number_of_a_release_is_that_under_the_tag() {
        let mut release = [&golden("elbow")[..], &release_block(7)].concat();
        release.extend(KEY.tag(&release));
        let dump = slot(1, &release);
        let found = |key: Option<&Key>| images(&dump, key.map(Trust::Key)).remove(0);
        assert_eq!((found(Some(&KEY)).release, found(Some(&KEY)).authentic), (7, Some(true)));
        assert_eq!((found(None).release, found(Some(&Key::new([4; 32]))).release), (0, 0));
    }

    fn slot(sequence: u32, image: &[u8]) -> Vec<u8> {
        let mut slot = [&slot_header(sequence, image).unwrap()[..], image].concat();
        slot.resize(2048, 0xFF);
        slot
    }

    #[test]
    fn images_are_found_with_their_slots_and_tags() {
        let (elbow, stribeck) = (golden("elbow"), golden("stribeck"));
        let tagged = [&stribeck[..], &KEY.tag(&stribeck)].concat();
        let dump = [vec![0xFF; 100], slot(u32::MAX, &elbow), slot(0, &tagged)].concat();
        let found = images(&dump, Some(Trust::Key(&KEY)));
        let places: Vec<_> = found.iter().map(|image| (image.offset, image.sequence, image.authentic)).collect();
        assert_eq!(places, [(116, Some(u32::MAX), Some(false)), (2164, Some(0), Some(true))]);
        assert_eq!(found[0].image.as_ref().unwrap().0, elbow);
        assert_eq!(in_use(&found).unwrap().offset, 2164);
        // Without a key the first tag is no matter, and numbers run on through zero.
        assert_eq!(in_use(&images(&dump, None)).unwrap().offset, 2164);
        // Flash words of 32 bytes.
        let apart = [&slot_header(3, &elbow).unwrap()[..], &[0; 16], &elbow].concat();
        assert_eq!(images(&apart, None)[0].sequence, Some(3));
        let only_first = images(&dump[..2148], None);
        assert_eq!(in_use(&only_first).unwrap().offset, 116);
    }

    #[test]
    fn a_damaged_image_is_found_and_not_used() {
        let mut dump = slot(1, &golden("elbow"));
        dump[60] ^= 1;
        let found = images(&dump, None);
        assert_eq!(found[0].image.as_ref().err(), Some(&ImageError::CrcMismatch));
        assert!(found[0].sequence.is_none() && in_use(&found).is_none());
        assert!(images(&[0xFF; 64], None).is_empty());
    }
}
