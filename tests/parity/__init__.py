"""The core against the NumPy reference."""
