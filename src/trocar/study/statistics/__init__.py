"""What two curves have in common: the published tests, and those that answer the question."""
