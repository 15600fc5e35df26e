"""What a calibration says: in words, on a page, in files."""
