"""Tasks: what is asked of a trainee, step by step, and what counts as a mistake."""
