"""What a model leaves of a dataset: rollouts as the camera sees them, compared in units of the noise."""
