"""Time to accuracy: cases, ladders of steps, times and the page."""
