"""Tissue as waves: modes from membranes and layered solids, one exact propagator."""
