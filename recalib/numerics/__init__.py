"""What is computed with: compiled loops, random numbers, regression."""
