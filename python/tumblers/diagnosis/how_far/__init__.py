"""How far the gap shrinks on trials that no fit saw, and what these look like over the model."""
