"""What causes the gap: the search over the catalogue, the evidence, what is tied, the intervals and the verdict."""
