//! Memory of the firmware: that whose content is the library's, and that which is only read. Audit: a content is read only behind the mark that
//! [`start`] leaves, a length is the caller's word, and no reference outlives the call for which the caller gives it.

use core::mem::MaybeUninit;
use core::slice;

/// Memory that lies with the firmware: a mark, and words for the content. Zeroed memory holds nothing.
///
/// # Safety
/// The pointers of `parts` lie within the memory, and the words are large enough and aligned for the content.
pub(crate) unsafe trait Memory: Sized {
    /// What lies in it once it is started.
    type Content;
    /// Value of the mark behind which there is a content.
    const MARK: u32;

    /// The mark and the place of the content.
    fn parts(memory: *mut Self) -> (*mut u32, *mut Self::Content);
}

/// Puts a content into its memory; false for a null pointer.
///
/// # Safety
/// `memory` is null or may be written to.
pub(crate) unsafe fn start<M: Memory>(memory: *mut M, content: M::Content) -> bool {
    // SAFETY: the caller's word.
    let Some(memory) = (unsafe { memory.cast::<MaybeUninit<M>>().as_mut() }) else { return false };
    let (mark, place) = M::parts(memory.as_mut_ptr());
    // SAFETY: both lie in the memory, as the trait promises. A content that was there before needs no drop.
    unsafe {
        place.write(content);
        mark.write(M::MARK);
    }
    true
}

/// The content of a memory, where it was started.
///
/// # Safety
/// `memory` is null or points to initialised memory that nobody else uses during the call.
pub(crate) unsafe fn content<'a, M: Memory>(memory: *mut M) -> Option<&'a mut M::Content> {
    if memory.is_null() {
        return None;
    }
    let (mark, place) = M::parts(memory);
    // SAFETY: the caller's word; only `start` leaves this mark, and after it nobody but the content writes to its place.
    unsafe { (mark.read() == M::MARK).then(|| &mut *place) }
}

/// Bytes of C; none for a null pointer.
///
/// # Safety
/// `bytes` is null or `length` bytes may be read from it during the call.
pub(crate) unsafe fn readable<'a>(bytes: *const u8, length: usize) -> &'a [u8] {
    // SAFETY: the caller's word; no object is larger than `isize::MAX`.
    if bytes.is_null() || length > isize::MAX as usize { &[] } else { unsafe { slice::from_raw_parts(bytes, length) } }
}
