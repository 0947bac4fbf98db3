"""What a model leaves of a dataset: rollouts as the camera sees them, against the noise that a right one leaves."""
