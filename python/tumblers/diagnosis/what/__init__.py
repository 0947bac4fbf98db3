"""What causes the gap: the search over the catalogue, what is tied, the numbers, the probabilities and the verdict."""
