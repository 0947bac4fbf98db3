"""Every result of the paper, run again: our number beside the paper's, and a tested reason where they part."""
