"""What is estimated: the errors of an arm as parameters, and the residuals of measurements."""
