"""Every figure of the study, with its words, in the order of the report."""

from __future__ import annotations

from collections.abc import Mapping

from trocar.study.protocol import MODEL, REFERENCE, Study
from trocar.study.report.figures.agreement import (
    bland_altman_alt,
    bland_altman_figure,
    uncertainty_alt,
    uncertainty_figure,
)
from trocar.study.report.figures.angle_and_pair import angle_and_pair_alt, angle_and_pair_figure
from trocar.study.report.figures.block import block_alt, block_figure
from trocar.study.report.figures.cost import cost_alt, cost_figure
from trocar.study.report.figures.deflection import deflection_alt, deflection_figure
from trocar.study.report.figures.film import film_alt, film_figure
from trocar.study.report.figures.in_time import tap_alt, tap_figure
from trocar.study.report.figures.normal import normal_alt, normal_figure
from trocar.study.report.figures.style import label
from trocar.study.report.figures.supports import supports_alt, supports_figure
from trocar.study.report.figures.validity import validity_alt, validity_figure
from trocar.study.report.picture import Picture
from trocar.units import MILLIMETRE

FREE_BASE = (
    " The lower face is free and not computed: it is drawn parallel to the upper face of the lowest layer."
)


def pictures(study: Study) -> Mapping[str, Picture]:
    """Draw every figure, by name."""
    small, paper = study.small, study.paper
    tilted, pair = (study.tilted.case, study.surfaces["tilted"]), (study.pair.case, study.surfaces["pair"])
    depths = {layer: float(curve.max()) for layer, curve in small[REFERENCE].deflection.items()}
    costs = {"Press, quasi-static": small, "Tap, in time": study.tap}
    thickness = paper.case.tissue.thickness / MILLIMETRE
    drawn = (
        Picture(
            name="exploded-block",
            alt=block_alt(small.case, study.surfaces["small"]),
            caption=f"The layers of the block under {small.case.peak_force:g} N, as {label(MODEL)} deforms them. The "
            "hatching tells the layers apart." + ("" if small.case.support.base_held else FREE_BASE),
            figure=block_figure(small.case, study.surfaces["small"]),
        ),
        Picture(
            name="deflection-small-load",
            alt=deflection_alt(small),
            caption=f"Largest deflection against time under {small.case.peak_force:g} N. Below, each wave model minus "
            "finite elements.",
            figure=deflection_figure(small),
        ),
        Picture(
            name="deflection-paper-load",
            alt=deflection_alt(paper) + f" The block is only {thickness:.3g} mm thick.",
            caption=f"The same under the paper's {paper.case.peak_force:g} N. Not a prediction: linear "
            "models that agree "
            "with one another are not thereby right.",
            figure=deflection_figure(paper, depth_limit=True),
        ),
        Picture(
            name="validity",
            alt=validity_alt(study.validity),
            caption="Where each wave model may be trusted: the largest error of any layer's deflection "
            "against hyperelastic finite elements. Each bar ends where the reference did; beside it, the deflection "
            "there over the block's thickness.",
            figure=validity_figure(study.validity),
        ),
        Picture(
            name="supports",
            alt=supports_alt(study.supports),
            caption="Clamped sides are no sine waves: tractions on them hold the layered waves, and the membranes are "
            "fitted to the result.",
            figure=supports_figure(study.supports),
        ),
        Picture(
            name="angle-and-pair",
            alt=angle_and_pair_alt(tilted, pair),
            caption=f"The top face as {label(MODEL)} gives it; arrows are the forces along the tools.",
            figure=angle_and_pair_figure(tilted, pair),
        ),
        Picture(
            name="tap",
            alt=tap_alt(study.tap),
            caption="A tap: the deflection lags behind the force because the tissue has mass and damping.",
            figure=tap_figure(study.tap),
        ),
        Picture(
            name="filmstrip",
            alt=film_alt(study.film),
            caption="Moments of the film: pressing (a to c), let go at once (d), swinging back to the "
            "rest shape (e, f).",
            figure=film_figure(study.film),
        ),
        Picture(
            name="normal-distributions",
            alt=normal_alt(paper),
            caption="Normal distributions as the paper fits them, over the samples they are fitted to.",
            figure=normal_figure(paper),
        ),
        Picture(
            name="bland-altman",
            alt=bland_altman_alt(small),
            caption="Difference against mean, with bias and limits of agreement over all layers.",
            figure=bland_altman_figure(small),
        ),
        Picture(
            name="error-and-uncertainty",
            alt=uncertainty_alt(study.numerics),
            caption="What is left between the models on the finest mesh with the most modes. A bar that reaches zero "
            "means that the difference cannot be told from numerical error.",
            figure=uncertainty_figure(study.numerics, depths),
        ),
        Picture(
            name="cost",
            alt=cost_alt(costs),
            caption="Processor time for the same case, set-up included; compilation is not.",
            figure=cost_figure(costs),
        ),
    )
    return {picture.name: picture for picture in drawn}
