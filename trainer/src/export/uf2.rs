//! UF2, the format of drag-and-drop boot loaders (Microsoft, github.com/microsoft/uf2): blocks of 512 bytes, 256 of them payload.

/// Bytes of a page: what one block holds.
pub const PAGE_BYTES: usize = 256;

const MAGIC_START: [u32; 2] = [0x0A32_4655, 0x9E5D_5157];
const MAGIC_END: u32 = 0x0AB1_6F30;
const FAMILY_PRESENT: u32 = 0x2000;
const BLOCK_BYTES: usize = 512;
const DATA_BYTES: usize = 476;

/// The blocks of `bytes` for a processor family, from the address `first` on, a multiple of 256 from which they reach below 2^32; boot loaders
/// write whole pages, so that the last page is filled with the pattern of erased flash.
#[must_use]
pub fn uf2(bytes: &[u8], first: u32, family: u32) -> Vec<u8> {
    let pages = bytes.chunks(PAGE_BYTES);
    let blocks = pages.len() as u32;
    let mut file = Vec::with_capacity(pages.len() * BLOCK_BYTES);
    for (block, page) in (0u32..).zip(pages) {
        let address = first.wrapping_add(block * PAGE_BYTES as u32);
        let [start, second] = MAGIC_START;
        let words = [start, second, FAMILY_PRESENT, address, PAGE_BYTES as u32, block, blocks, family];
        file.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        let mut data = [0; DATA_BYTES];
        data[..PAGE_BYTES].fill(0xFF);
        data[..page.len()].copy_from_slice(page);
        file.extend(data);
        file.extend(MAGIC_END.to_le_bytes());
    }
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_carry_the_bytes_to_their_addresses() {
        let bytes: Vec<u8> = (0..600u32).map(|i| i as u8).collect();
        let file = uf2(&bytes, 0x1000_0000, 0xE48B_FF56);
        assert_eq!(file.len(), 3 * BLOCK_BYTES);
        let mut read: Vec<u8> = Vec::new();
        for (index, block) in file.chunks(BLOCK_BYTES).enumerate() {
            let word = |at: usize| u32::from_le_bytes(block[at..at + 4].try_into().unwrap());
            assert_eq!((word(0), word(4), word(508)), (0x0A32_4655, 0x9E5D_5157, 0x0AB1_6F30));
            assert_eq!((word(8), word(28)), (0x2000, 0xE48B_FF56));
            assert_eq!(word(12), 0x1000_0000 + 256 * index as u32);
            assert_eq!((word(16), word(20), word(24)), (256, index as u32, 3));
            read.extend(&block[32..32 + 256]);
        }
        assert_eq!(read[..600], bytes);
        assert!(read[600..].iter().all(|byte| *byte == 0xFF));
    }
}
