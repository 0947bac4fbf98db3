"""A run as an interactive 3-D page."""

from .page import view_page

__all__ = ["view_page"]
