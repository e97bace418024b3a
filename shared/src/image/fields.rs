//! The fields of a payload in their order, read where they lie: the wire format of postcard without a decoder.

/// What is left of a payload. Once it has ended every further field is 0, so that it is enough to ask at the end.
pub(super) struct Fields<'a> {
    rest: &'a [u8],
    were_there: bool,
}

impl<'a> Fields<'a> {
    pub(super) fn new(payload: &'a [u8]) -> Self {
        Self { rest: payload, were_there: true }
    }

    /// Whether every field was there, and nothing is left.
    pub(super) fn are_all(&self) -> bool {
        self.were_there && self.rest.is_empty()
    }

    /// So many bytes; none where there are not so many.
    #[inline(never)]
    pub(super) fn bytes(&mut self, count: usize) -> &'a [u8] {
        if let Some((bytes, rest)) = self.rest.split_at_checked(count) {
            self.rest = rest;
            bytes
        } else {
            *self = Self { rest: &[], were_there: false };
            &[]
        }
    }

    /// One byte.
    pub(super) fn byte(&mut self) -> u8 {
        self.bytes(1).first().copied().unwrap_or(0)
    }

    /// An unsigned number, of which the lowest 32 bits count.
    #[inline(never)]
    pub(super) fn number(&mut self) -> u32 {
        let (mut number, mut shift) = (0u32, 0);
        loop {
            let byte = self.byte();
            number |= u32::from(byte & 0x7F).wrapping_shl(shift);
            shift += 7;
            // Behind the end there are zeros.
            if byte & 0x80 == 0 {
                return number;
            }
        }
    }

    /// A name: its bytes behind their number.
    #[inline(never)]
    pub(super) fn name(&mut self) -> &'a [u8] {
        let length = self.number();
        self.bytes(length as usize)
    }

    /// A float.
    #[inline(never)]
    pub(super) fn float(&mut self) -> f32 {
        self.bytes(4).first_chunk().copied().map_or(0.0, f32::from_le_bytes)
    }

    /// A number of 32 bits: those of a float, so that one function reads both.
    #[inline(always)]
    pub(super) fn word(&mut self) -> u32 {
        self.float().to_bits()
    }
}
