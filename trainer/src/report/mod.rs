//! Pictures and pages. Only commands know this room.
