"""Where the gap lies: by channel, trial, time, phase, place and contact mode, and the wrench that is missing."""
