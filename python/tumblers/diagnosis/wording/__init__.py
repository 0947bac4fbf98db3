"""Words for a diagnosis: names and units, the conditions of trials, cautions and the summary."""
