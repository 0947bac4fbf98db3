"""Studies around the model: what a robot climbs, what errors it bears, which shape is best, what a number rests on."""
