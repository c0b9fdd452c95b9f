"""What the live contact keeps to: energy, quiet, static answers, and a surface that lets nothing in."""
