"""The page of a diagnosis, and its parts."""
