"""Objective measures of an attempt, each a function of what was recorded alone."""
