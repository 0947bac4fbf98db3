"""A diagnosis in plain words."""
