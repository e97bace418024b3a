//! The Kolmogorov-Arnold network: splines, loss and gradient, optimisers, attribution, pruning. Knows no files.
