"""The results of a calibration as text, page, recording and files."""
