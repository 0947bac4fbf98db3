"""The trial that best separates what is still tied: draws of each, what they foretell, and what that would tell."""
