"""Calibration: parameters of a tissue from measured force and displacement, and how far the data tell them."""
