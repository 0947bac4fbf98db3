"""What the numbers can be trusted for (docs/trust.md)."""
