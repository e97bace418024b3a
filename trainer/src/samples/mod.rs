//! From a recording to samples: filters, derivatives, rigid body removed, blocks. Knows no model.
