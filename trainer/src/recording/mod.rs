//! Recordings in: formats, columns, units and checks. Knows no model.
