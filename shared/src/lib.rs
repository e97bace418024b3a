//! What the Frikan trainer and runtime both mean by a friction model: inputs, tables, expressions, effects, image.
#![no_std]
