//! Symbolic laws: known forms, function library, search, simplification, names, rendering. Knows no files.
