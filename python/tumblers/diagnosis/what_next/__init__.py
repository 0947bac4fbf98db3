"""The trial that best separates what is still tied."""
