"""Diagnosis of the gap between a lab's measurements and its nominal model."""

from .diagnose import diagnose
from .diagnosis import Diagnosis
from .how_far.held_out import shrink
from .what.attribute import attribute
from .what_next.next_trial import next_trials
from .where.localise import localise
from .where.wrench import missing_wrench

__all__ = ["Diagnosis", "attribute", "diagnose", "localise", "missing_wrench", "next_trials", "shrink"]
