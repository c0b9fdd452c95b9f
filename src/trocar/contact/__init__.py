"""Instruments and how they touch: ports, tips, unilateral contact and friction, on plain arrays."""
