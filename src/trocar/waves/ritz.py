"""Few oscillators per wavenumber that keep the static response exact.

Instead of the lowest eigenmodes through the thickness and a static residual for the rest, the displacement is sought
in load-dependent Ritz vectors: the static response to a traction on the top face, K^-1 p, then what its inertia
does, K^-1 M K^-1 p, and what uneven damping does, K^-1 C K^-1 p (Wilson, Yuan and Dickens 1982, Earthquake Eng
Struct Dyn 10:813; as moment matching: Bai 2002, Appl Numer Math 43:9). The first vector alone makes every static
answer that of all modes together, residual included; each further one matches a moment of the response in time.

Layers that remember unlike each other answer a slow load in shapes that lie between the relaxed K^-1 p and the sudden
(K + G)^-1 p, G the sum of all branches. Both are kept, and the answer K(s)^-1 p at the real s of a few relaxation
times between them: interpolation at rational points (Grimme 1997; Antoulas 2005, Approximation of Large-Scale Dynamical
Systems, ch. 11). Inertia is then fed back through the sudden stiffness.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trocar.model import FloatArray
from trocar.waves.decouple import symmetric
from trocar.waves.memory import Memory, alike, between
from trocar.waves.oscillators import Oscillators, joined
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
    return _by_chunks(at, lambda part: _reduce(layers, part, order, everywhere))


def creeping_oscillators(layers: ThinLayers, at: Wavenumbers) -> Oscillators:
    """Reduce J wavenumbers to what they remember, without inertia and damping; see `Oscillators.massless`.

    Args:
        layers: matrices through the thickness, c components a node, of a tissue that remembers.
        at: J wavenumbers.

    Returns:
        Oscillators with c inputs (traction amplitudes on the top face) and c outputs for each layer's upper face.
    """
    return _by_chunks(at, lambda part: _creeping(layers, part))


def _by_chunks(at: Wavenumbers, build: Callable[[Wavenumbers], Oscillators]) -> Oscillators:
    pieces = []
    for start in range(0, len(at.k), _CHUNK):
        part = slice(start, start + _CHUNK)
        pieces.append(build(Wavenumbers(at.k[part], at.kx2[part], at.ky2[part])))
    return joined(pieces)


def _reduce(layers: ThinLayers, at: Wavenumbers, order: int, everywhere: bool) -> Oscillators:
    stiffness, damping = layers.stiffness(at), layers.damping(at)
    flexibility = np.linalg.inv(stiffness)
    components = layers.components
    response = flexibility[:, :, -components:]
    spread = np.ptp(layers.retardation)
    uneven = spread > _EVEN * layers.retardation.max() or (layers.prestressed and layers.retardation.any())
    creeps = _creeps_unevenly(layers)
    branches = layers.remembered(at)
    sudden = np.linalg.inv(stiffness + branches.sum(axis=0)) if creeps else flexibility
    families = [response]
    if creeps:
        families += _between(layers, stiffness, branches)
    inertial = families[-1]
    for _ in range(order - 1):
        inertial = sudden @ (layers.mass @ inertial)
        families.append(inertial)
    if uneven:
        families.insert(1, sudden @ (damping @ response))
    basis = _orthonormal(np.concatenate(families[: layers.size // components], axis=2), stiffness)
    transposed = np.swapaxes(basis, 1, 2)
    return Oscillators.of(
        mass=symmetric(transposed @ layers.mass @ basis),
        damping=symmetric(transposed @ damping @ basis),
        stiffness=_identity(basis),
        forcing=transposed[:, :, -components:],
        reading=basis if everywhere else basis[:, _face_unknowns(layers)],
        memory=_memory(layers, branches, basis) if len(branches) else None,
    )


def _creeping(layers: ThinLayers, at: Wavenumbers) -> Oscillators:
    stiffness, components = layers.stiffness(at), layers.components
    branches = layers.remembered(at)
    families = [_pushed(stiffness, components)]
    if _creeps_unevenly(layers):
        families += _between(layers, stiffness, branches)
    basis = _orthonormal(np.concatenate(families[: layers.size // components], axis=2), stiffness)
    return Oscillators.massless(
        stiffness=_identity(basis),
        forcing=np.swapaxes(basis, 1, 2)[:, :, -components:],
        reading=basis[:, _face_unknowns(layers)],
        memory=_memory(layers, branches, basis),
    )


def _creeps_unevenly(layers: ThinLayers) -> bool:
    """Whether shapes change while layers relax: they do not where every layer has the same series."""
    return bool(len(layers.relaxation)) and (layers.prestressed or not alike(layers.relaxing))


def _between(layers: ThinLayers, stiffness: FloatArray, branches: FloatArray) -> list[FloatArray]:
    """Return the answers at 1/tau of a few relaxation times, the slowest first, and the sudden one at last."""
    sudden = np.ones(len(layers.relaxation))
    return [
        _pushed(stiffness + np.tensordot(share, branches, 1), layers.components)
        for share in (*between(layers.relaxation), sudden)
    ]


def _pushed(stiffness: FloatArray, components: int) -> FloatArray:
    """Return the answer to unit tractions on the top face, shape (J, nc, c)."""
    tractions = np.eye(stiffness.shape[1])[:, -components:]
    every = np.broadcast_to(tractions, (len(stiffness), *tractions.shape))
    return np.asarray(np.linalg.solve(stiffness, every), dtype=np.float64)


def _memory(layers: ThinLayers, branches: FloatArray, basis: FloatArray) -> Memory:
    reduced = np.swapaxes(basis, 1, 2) @ branches @ basis
    return Memory(times=layers.relaxation, stiffness=symmetric(reduced))


def _face_unknowns(layers: ThinLayers) -> list[int]:
    return [layers.unknown(layer, c) for layer in range(len(layers.faces)) for c in range(layers.components)]


def _identity(basis: FloatArray) -> FloatArray:
    order = basis.shape[2]
    return np.broadcast_to(np.eye(order), (len(basis), order, order))


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
