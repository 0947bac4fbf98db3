"""Diagnosis of the gap between a lab's measurements and its nominal model."""

from .attribute import attribute
from .diagnose import diagnose
from .diagnosis import Diagnosis
from .held_out import shrink
from .localise import localise
from .next_trial import next_trials
from .wrench import missing_wrench

__all__ = ["Diagnosis", "attribute", "diagnose", "localise", "missing_wrench", "next_trials", "shrink"]
