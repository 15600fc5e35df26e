"""Runs first in the Python of every job: an interrupt ends it at once, like any other program.

Otherwise Python would print a traceback after Ctrl-C. The next run removes temporary files of the
interrupted job.
"""

import signal

signal.signal(signal.SIGINT, signal.SIG_DFL)
