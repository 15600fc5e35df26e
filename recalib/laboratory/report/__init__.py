"""The results of a calibration as text, as a page, as a recording and as files."""
