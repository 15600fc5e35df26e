"""Pages: what each says of the results, in words."""
