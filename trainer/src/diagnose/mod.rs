//! Which physics is missing: noise, evidence, calibration, naming, localising, proving, advising.
