"""What types cannot say of a study: trainings, claims and robots are asked."""
