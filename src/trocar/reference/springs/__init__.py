"""Mass-springs done well: a lattice of Kelvin-Voigt springs whose constants follow from the layers' moduli."""
