"""Diagnosis of the gap between a lab's measurements and its nominal model."""

from .diagnose import diagnose
from .result import Diagnosis

__all__ = ["Diagnosis", "diagnose"]
