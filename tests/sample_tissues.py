"""Tissues that tests share."""

from trocar.tissues import Layer, Tissue


def three_layers(**dermis):
    """Skin-like layers, evenly damped; keywords change the dermis."""
    base = {"poisson_ratio": 0.48, "density": 1100.0, "loss_factor": 0.14, "loss_frequency": 50.0}
    return Tissue(
        name="three layers",
        layers=(
            Layer(name="epidermis", thickness=1e-4, young_modulus=1e6, **base),
            Layer(**({"name": "dermis", "thickness": 1e-3, "young_modulus": 2e5} | base | dermis)),
            Layer(name="fat", thickness=1e-2, young_modulus=1e4, **base),
        ),
    )
