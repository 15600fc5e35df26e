"""What a study consists of: trainings, competitors, recordings, jobs."""
