"""Case files and the experiments they describe."""
