"""The study's figures: one concept a file, each a function from results to a matplotlib Figure and one to its alt text.

They are drawn without pyplot, so nothing global is touched and nothing needs a screen. `style` holds what all share.
"""
