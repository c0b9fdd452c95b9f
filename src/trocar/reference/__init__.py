"""The models the waves are judged against; they share no code with them."""

from trocar.reference.block import MeshSize
from trocar.reference.fea import FEASolid
from trocar.reference.state import FEAState

__all__ = ["FEASolid", "FEAState", "MeshSize"]
