"""A taut sheet that can be cut: the paper's waves on a lattice of links, for a cut would change their modes."""
