"""Trocar: a laparoscopy trainer whose soft tissue is a wave equation, and the laboratory that judges it."""

from trocar.tissues import Layer, Tissue
from trocar.tissues.catalogue import tissue

__version__ = "0.1.0"

__all__ = ["Layer", "Tissue", "tissue"]
