"""Blind tests: worlds that are not the model, with a truth that is drawn, sealed, diagnosed and scored."""
