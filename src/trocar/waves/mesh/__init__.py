"""Waves of any shape: finite-element modes of a mesh, and what is left of its static answer."""
