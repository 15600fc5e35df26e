"""The damaged robot: damages, disturbances, and the plant that executes commands."""
