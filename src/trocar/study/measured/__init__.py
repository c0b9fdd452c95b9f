"""The study's third leg: models held against what was measured on silicone, limbs, tissue and rubber."""
