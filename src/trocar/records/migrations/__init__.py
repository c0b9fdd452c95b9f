"""Each schema as a step from the one before. `trocar.records.schema` takes them, in one transaction."""
