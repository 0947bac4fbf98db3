"""How far the gap shrinks on trials that no fit saw."""
