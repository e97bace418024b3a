//! Bytes in turn, of which there may be fewer than a file says.

/// What is left of some bytes, and how far they have been read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cursor<'a> {
    all: &'a [u8],
    at: usize,
    /// Whether numbers are most significant byte first.
    pub(super) big_endian: bool,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(all: &'a [u8], big_endian: bool) -> Self {
        Self { all, at: 0, big_endian }
    }

    pub(super) fn is_at_end(&self) -> bool {
        self.at >= self.all.len()
    }

    /// The next `count` bytes; `None` where there are fewer.
    pub(super) fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let bytes = self.all.get(self.at..self.at.checked_add(count)?)?;
        self.at += count;
        Some(bytes)
    }

    /// Goes on to the next multiple of `size` from the start, at the furthest to the end.
    pub(super) fn align(&mut self, size: usize) {
        self.at = self.at.next_multiple_of(size).min(self.all.len());
    }

    pub(super) fn u8(&mut self) -> Option<u8> {
        self.take(1).map(|bytes| bytes[0])
    }

    pub(super) fn u16(&mut self) -> Option<u16> {
        let bytes = self.take(2)?.try_into().ok()?;
        Some(if self.big_endian { u16::from_be_bytes(bytes) } else { u16::from_le_bytes(bytes) })
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        let bytes = self.take(4)?.try_into().ok()?;
        Some(if self.big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        let bytes = self.take(8)?.try_into().ok()?;
        Some(if self.big_endian { u64::from_be_bytes(bytes) } else { u64::from_le_bytes(bytes) })
    }

    /// A length as a file writes it.
    pub(super) fn length(&mut self) -> Option<usize> {
        self.u32().and_then(|length| usize::try_from(length).ok())
    }

    pub(super) fn f64(&mut self) -> Option<f64> {
        self.u64().map(f64::from_bits)
    }

    pub(super) fn f32(&mut self) -> Option<f32> {
        self.u32().map(f32::from_bits)
    }

    /// A number of `kind` in `size` bytes; `None` where there is no such number or no such bytes.
    pub(super) fn number(&mut self, kind: Kind, size: usize) -> Option<Number> {
        Some(match (kind, size) {
            (Kind::Float, 8) => Number::Float(self.f64()?),
            (Kind::Float, 4) => Number::Float(f64::from(self.f32()?)),
            (Kind::Unsigned, 1) => Number::Whole(i128::from(self.u8()?)),
            (Kind::Unsigned, 2) => Number::Whole(i128::from(self.u16()?)),
            (Kind::Unsigned, 4) => Number::Whole(i128::from(self.u32()?)),
            (Kind::Unsigned, 8) => Number::Whole(i128::from(self.u64()?)),
            (Kind::Signed, 1) => Number::Whole(i128::from(self.u8()?.cast_signed())),
            (Kind::Signed, 2) => Number::Whole(i128::from(self.u16()?.cast_signed())),
            (Kind::Signed, 4) => Number::Whole(i128::from(self.u32()?.cast_signed())),
            (Kind::Signed, 8) => Number::Whole(i128::from(self.u64()?.cast_signed())),
            _ => return None,
        })
    }
}

/// How a number is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Float,
    Signed,
    Unsigned,
}

/// A number as it was written; whole ones keep all their digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Number {
    Float(f64),
    Whole(i128),
}

/// The shortest text that is read back to the bit.
impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            // Very large and very small ones in powers of ten, as they would be hundreds of digits.
            Self::Float(value) if *value != 0.0 && !(1e-5..1e17).contains(&value.abs()) => write!(f, "{value:e}"),
            Self::Float(value) => write!(f, "{value}"),
            Self::Whole(value) => write!(f, "{value}"),
        }
    }
}
