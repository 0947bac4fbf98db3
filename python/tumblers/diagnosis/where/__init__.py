"""Where the gap lies, in which part of the data an effect acts, and the wrench that is missing."""
