//! Evaluates a Frikan friction model in fixed time: no allocation, no panic, no `unsafe`.
#![no_std]
