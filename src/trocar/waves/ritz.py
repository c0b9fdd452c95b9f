"""Few oscillators per wavenumber that keep the static response exact.

Instead of the lowest eigenmodes through the thickness and a static residual for the rest, the displacement is sought
in load-dependent Ritz vectors: the static response to a traction on the top face, K^-1 p, then what its inertia
does, K^-1 M K^-1 p, and what uneven damping does, K^-1 C K^-1 p (Wilson, Yuan and Dickens 1982, Earthquake Eng
Struct Dyn 10:813; as moment matching: Bai 2002, Appl Numer Math 43:9). The first vector alone makes every static
answer that of all modes together, residual included; each further one matches a moment of the response in time.
"""

from __future__ import annotations

import numpy as np

from trocar.model import FloatArray
from trocar.waves.oscillators import Oscillators
from trocar.waves.thin_layer import ThinLayers, Wavenumbers

_CHUNK = 256  # wavenumbers at a time: 256 dense matrices of 60 x 60 are 7 MiB
_EVEN = 1e-12  # relative spread of retardation times that counts as none


def ritz_oscillators(
    layers: ThinLayers, at: Wavenumbers, order: int, *, everywhere: bool = False
) -> Oscillators:
    """Reduce J wavenumbers to a few oscillators each.

    Args:
        layers: matrices through the thickness, c components a node.
        at: J wavenumbers.
        order: how often inertia is fed back; order vectors per component, and one more where damping is uneven.
        everywhere: whether every node is read, base up; else the layers' upper faces are, top down.

    Returns:
        Oscillators with c inputs (traction amplitudes on the top face) and c outputs for each node or face read.
    """
    pieces = []
    for start in range(0, len(at.k), _CHUNK):
        part = slice(start, start + _CHUNK)
        pieces.append(_reduce(layers, Wavenumbers(at.k[part], at.kx2[part], at.ky2[part]), order, everywhere))
    return Oscillators(
        matrices=np.concatenate([piece.matrices for piece in pieces]),
        inputs=np.concatenate([piece.inputs for piece in pieces]),
        outputs=np.concatenate([piece.outputs for piece in pieces]),
        entry=np.concatenate([piece.entry for piece in pieces]),
        holds=np.concatenate([piece.holds for piece in pieces]),
    )


def _reduce(layers: ThinLayers, at: Wavenumbers, order: int, everywhere: bool) -> Oscillators:
    stiffness, damping = layers.stiffness(at), layers.damping(at)
    flexibility = np.linalg.inv(stiffness)
    components = layers.components
    response = flexibility[:, :, -components:]
    families = [response]
    for _ in range(order - 1):
        families.append(flexibility @ (layers.mass @ families[-1]))
    spread = np.ptp(layers.retardation)
    prestressed = layers.prestress_x.any() or layers.prestress_y.any()
    if spread > _EVEN * layers.retardation.max() or (prestressed and layers.retardation.any()):
        families.insert(1, flexibility @ (damping @ response))
    families = families[: layers.size // components]
    basis = _orthonormal(np.concatenate(families, axis=2), stiffness)

    transposed = np.swapaxes(basis, 1, 2)
    order_kept = basis.shape[2]
    identity = np.broadcast_to(np.eye(order_kept), (len(basis), order_kept, order_kept))
    faces = [layers.unknown(layer, c) for layer in range(len(layers.faces)) for c in range(components)]
    return Oscillators.of(
        mass=_symmetric(transposed @ layers.mass @ basis),
        damping=_symmetric(transposed @ damping @ basis),
        stiffness=identity,
        forcing=transposed[:, :, -components:],
        reading=basis if everywhere else basis[:, faces],
    )


def _orthonormal(vectors: FloatArray, stiffness: FloatArray) -> FloatArray:
    """Gram-Schmidt in the energy product, twice, so that a nearly dependent vector still ends up orthogonal."""
    kept: list[FloatArray] = []
    for column in range(vectors.shape[2]):
        v = vectors[:, :, column]
        for _ in range(3):
            loaded = np.einsum("jab,jb->ja", stiffness, v)
            v = v / np.sqrt(np.einsum("ja,ja->j", v, loaded))[:, None]
            for other in kept:
                v = v - np.einsum("ja,ja->j", np.einsum("jab,jb->ja", stiffness, other), v)[:, None] * other
        v = v / np.sqrt(np.einsum("ja,jab,jb->j", v, stiffness, v))[:, None]
        kept.append(v)
    return np.stack(kept, axis=2)


def _symmetric(matrices: FloatArray) -> FloatArray:
    result: FloatArray = 0.5 * (matrices + np.swapaxes(matrices, 1, 2))
    return result
