"""Trocar: a laparoscopy trainer whose soft tissue is a wave equation, and the laboratory that judges it."""

__version__ = "0.1.0"
