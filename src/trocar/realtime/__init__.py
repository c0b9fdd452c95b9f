"""The servo: the tissue and both instruments at a fixed rate, in a process of its own that can fail alone."""
