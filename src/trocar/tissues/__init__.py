"""Tissues: frozen layers and the presets, each property with its source."""

from trocar.tissues.law import Fibre, Law, Linear, NeoHookean, Ogden
from trocar.tissues.layer import Layer
from trocar.tissues.record import TissueRecord
from trocar.tissues.tissue import Tissue

__all__ = ["Fibre", "Law", "Layer", "Linear", "NeoHookean", "Ogden", "Tissue", "TissueRecord"]
